/* The derivative of a period of the processed splitting, and the motion of neighbours, from the reduced angles at every
 * kick that stages.c keeps; in single precision, which is enough for errors. */
#include "vector/vector.h"

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 1
#error "the processed splitting is made for fused operations: -ffp-contract=fast (cmake/Compilers.cmake)"
#endif

/* Coefficients of a slope (stages.f90); vectors at once; lanes of a vector. */
enum { TERMS = 5, CHAINS = VECTOR_BYTES / 16, LANES = VECTOR_BYTES / 4 };
/* GROUP and POINTS of stages.f90: orbits whose neighbours are moved together, and neighbours of each. */
enum { KZ_GROUP = 16, KZ_POINTS = 2 };
#define EACH _Pragma("GCC unroll 4") for (int i = 0; i < CHAINS; i++)
#define EACH_POINT _Pragma("GCC unroll 2") for (int i = 0; i < KZ_POINTS; i++)

typedef float floats __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(float)), may_alias));

static void store_vectors(float *to, const floats *x) {
  EACH *(floats *)(to + i * LANES) = x[i];
}

KZ_INLINE void move_tangents(bool mirrored, int64_t n_stages, const float *row, float last, float decay,
                             const float *kept, int64_t n, float *c) {
  for (int64_t first = 0; first < n; first += CHAINS * LANES) {
    const float *r = row, *x = kept + first;
    floats uu[CHAINS], uv[CHAINS], vu[CHAINS], vv[CHAINS], p[CHAINS], q[CHAINS], e[CHAINS];
    EACH uu[i] = vv[i] = 1 + (floats){0};
    EACH uv[i] = vu[i] = (floats){0};
    for (int64_t s = 0; s < n_stages; s++, r += 1 + 2 * TERMS, x += KZ_LANES) {
      EACH uu[i] += r[0] * vu[i];
      EACH uv[i] += r[0] * vv[i];
      EACH q[i] = *(const floats *)(x + i * LANES) * *(const floats *)(x + i * LANES);
      EACH p[i] = r[TERMS] + (floats){0};
      for (int j = TERMS - 1; j >= 1; j--) EACH p[i] = p[i] * q[i] + r[j];
      if (!mirrored) {
        EACH e[i] = r[2 * TERMS] + (floats){0};
        for (int j = 2 * TERMS - 1; j > TERMS; j--) EACH e[i] = e[i] * q[i] + r[j];
        EACH p[i] += e[i] * *(const floats *)(x + i * LANES);
      }
      EACH vu[i] -= p[i] * uu[i];
      EACH vv[i] -= p[i] * uv[i];
    }
    EACH uu[i] += last * vu[i];
    EACH uv[i] += last * vv[i];
    EACH vu[i] *= decay;
    EACH vv[i] *= decay;
    store_vectors(c + first, uu);
    store_vectors(c + KZ_LANES + first, uv);
    store_vectors(c + 2 * KZ_LANES + first, vu);
    store_vectors(c + 3 * KZ_LANES + first, vv);
  }
}

/* Computes the derivative of a period in single precision. row [n_stages][1 + 5 + 5]: a drift, the slope of a kick as a
 * polynomial of the square of the angle, and a second polynomial, times the angle, for pendulums without mirror
 * symmetry; last = the last drift. c [4][KZ_LANES] = d(u, v)/d(u0, v0), row by row. */
void kz_processed_tangents(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay,
                           const float *kept, int64_t n, float *c) {
  if (mirrored)
    move_tangents(true, n_stages, row, last, decay, kept, n, c);
  else
    move_tangents(false, n_stages, row, last, decay, kept, n, c);
}

/* The slope of a kick as a polynomial, its derivative, and half its second derivative: relative to their orbit,
 * neighbours feel the force to third order in the angle. */
typedef struct {
  floats value, slope, half_second;
} expansion;

KZ_INLINE expansion expand_slope(const float *c, floats q) {
  expansion p = {c[TERMS - 1] + (floats){0}, {0}, {0}};
  for (int j = TERMS - 2; j >= 0; j--) {
    p.half_second = p.half_second * q + p.slope;
    p.slope = p.slope * q + p.value;
    p.value = p.value * q + c[j];
  }
  return p;
}

KZ_INLINE void move_neighbours(bool mirrored, int64_t n_stages, const float *row, float last, float decay,
                               const float *angle, float *by) {
  floats u[KZ_POINTS], v[KZ_POINTS];
  EACH_POINT u[i] = *(floats *)(by + 2 * i * KZ_GROUP);
  EACH_POINT v[i] = *(floats *)(by + (2 * i + 1) * KZ_GROUP);
  for (int64_t s = 0; s < n_stages; s++, row += 1 + 2 * TERMS, angle += KZ_GROUP) {
    const floats r = *(const floats *)angle, q = r * r;
    const expansion odd = expand_slope(row + 1, q);
    floats first = odd.value, second = r * odd.slope, third = (1 / 3.0f) * (odd.slope + 4 * q * odd.half_second);
    if (!mirrored) {
      const expansion even = expand_slope(row + 1 + TERMS, q);
      first += r * even.value;
      second += 0.5f * even.value + q * even.slope;
      third += r * (even.slope + (4 / 3.0f) * q * even.half_second);
    }
    EACH_POINT u[i] += row[0] * v[i];
    EACH_POINT v[i] -= u[i] * (first + u[i] * (second + u[i] * third));
  }
  EACH_POINT *(floats *)(by + 2 * i * KZ_GROUP) = u[i] + last * v[i];
  EACH_POINT *(floats *)(by + (2 * i + 1) * KZ_GROUP) = decay * v[i];
}

/* Advances neighbours of n <= KZ_GROUP orbits by a period, relative to the orbits, in single precision. angle
 * [n_stages][KZ_GROUP]: angles of the orbits at the kicks; row, last, decay: as in kz_processed_tangents. by
 * [KZ_POINTS][2][KZ_GROUP], in and out: differences of angles (half-turns) and velocities. */
void kz_processed_displaced(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay, int64_t n,
                            const float *angle, float *by) {
  for (int64_t first = 0; first < n; first += LANES)
    if (mirrored)
      move_neighbours(true, n_stages, row, last, decay, angle + first, by + first);
    else
      move_neighbours(false, n_stages, row, last, decay, angle + first, by + first);
}
