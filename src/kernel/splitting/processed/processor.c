/* The polynomials of the processor of the processed splitting, in vectors: for every lane the sum over harmonics j and
 * powers n of c[n][j] v^n times sin(pi j u) for even n and cos(pi j u) for odd n, swapped in the second part. */
#include "vector/vector.h"

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 1
#error "the processed splitting is made for fused operations: -ffp-contract=fast (cmake/Compilers.cmake)"
#endif

/* Order of the series in doubles, and its harmonics: series_r64.f90, series.inc. */
enum { KZ_ORDER = 14, KZ_HARMONICS_KEPT = KZ_ORDER / 2 };
enum { LANES = VECTOR_BYTES / 8, CHAINS = 2, ROW = KZ_HARMONICS_KEPT + 1, PART = ROW * (KZ_ORDER + 1) };
#define EACH _Pragma("GCC unroll 2") for (int i = 0; i < CHAINS; i++)

/* Adds first (even powers of v) + second v (odd powers) to total, up to the even power `degree`. */
KZ_INLINE void add_harmonic(const double *c, int degree, const vector *first, const vector *second, const vector *v,
                            const vector *square, vector *total) {
  vector even[CHAINS], odd[CHAINS];
  EACH even[i] = c[degree * ROW] + (vector){0};
  EACH odd[i] = (vector){0};
  for (int power = degree - 1; power >= 1; power -= 2) {
    EACH odd[i] = odd[i] * square[i] + c[power * ROW];
    EACH even[i] = even[i] * square[i] + c[(power - 1) * ROW];
  }
  EACH total[i] = total[i] + first[i] * even[i] + second[i] * v[i] * odd[i];
}

static void change_vectors(int32_t mirrored, const double *theta, const double *velocity, const vector *sine,
                           const vector *cosine, vector *u, vector *v) {
  vector square[CHAINS], s[CHAINS], c[CHAINS], shift_u[CHAINS], shift_v[CHAINS], speed[CHAINS];
  EACH speed[i] = v[i];
  EACH square[i] = speed[i] * speed[i];
  EACH shift_u[i] = shift_v[i] = s[i] = (vector){0};
  EACH c[i] = 1 + (vector){0};
  for (int j = 0; j < ROW; j++) {
    const int degree = KZ_ORDER - 2 * (j > 1 ? j : 1);
    add_harmonic(theta + j, degree, s, c, speed, square, shift_u);
    add_harmonic(velocity + j, degree, s, c, speed, square, shift_v);
    if (!mirrored) {
      add_harmonic(theta + PART + j, degree, c, s, speed, square, shift_u);
      add_harmonic(velocity + PART + j, degree, c, s, speed, square, shift_v);
    }
    EACH {
      const vector former = s[i];
      s[i] = former * cosine[i] + c[i] * sine[i];
      c[i] = c[i] * cosine[i] - former * sine[i];
    }
  }
  EACH u[i] += shift_u[i];
  EACH v[i] += shift_v[i];
}

/* Adds processor(u, v) to (u, v), in whole blocks of lanes like kz_processed_kicks. theta, velocity [2][KZ_ORDER +
 * 1][KZ_HARMONICS_KEPT + 1]: processor_t of tables.inc. sine, cosine: sin(pi u), cos(pi u). */
void kz_processed_change(int32_t mirrored, const double *theta, const double *velocity, int64_t n, const double *sine,
                         const double *cosine, double *u, double *v) {
  for (int64_t i = 0; i < n; i += CHAINS * LANES)
    change_vectors(mirrored, theta, velocity, (const vector *)(sine + i), (const vector *)(cosine + i),
                   (vector *)(u + i), (vector *)(v + i));
}
