/* Neighbours of orbits over a period of the processed splitting, in single precision and relative to the orbits: the force between them and
 * their orbit is taken to third order in the angle, with the slopes of tangents.c and their derivatives. */
#include <stdbool.h>

#include "stages.h"

/* Coefficients of a slope (stages.f90). */
enum { TERMS = 5 };
#define EACH _Pragma("GCC unroll 6") for (int i = 0; i < KZ_POINTS; i++)
#define OPERATION static inline __attribute__((always_inline))

typedef float vector __attribute__((vector_size(4 * KZ_GROUP), aligned(sizeof(float)), may_alias));

/* A polynomial, its derivative, and half its second one. */
typedef struct {
  vector value, slope, bend;
} expansion;

OPERATION expansion expand(const float *c, vector q) {
  expansion p = {c[TERMS - 1] + (vector){0}, {0}, {0}};
  for (int j = TERMS - 2; j >= 0; j--) {
    p.bend = p.bend * q + p.slope;
    p.slope = p.slope * q + p.value;
    p.value = p.value * q + c[j];
  }
  return p;
}

OPERATION void run(bool mirrored, int64_t n_stages, const float *row, float last, float decay, const float *angle, float *by) {
  vector u[KZ_POINTS], v[KZ_POINTS], *const at = (vector *)by;
  EACH u[i] = at[2 * i];
  EACH v[i] = at[2 * i + 1];
  for (int64_t s = 0; s < n_stages; s++, row += 1 + 2 * TERMS) {
    const vector r = ((const vector *)angle)[s], q = r * r;
    const expansion odd = expand(row + 1, q);
    vector first = odd.value, second = r * odd.slope, third = (1 / 3.0f) * (odd.slope + 4 * q * odd.bend);
    if (!mirrored) {
      const expansion even = expand(row + 1 + TERMS, q);
      first += r * even.value;
      second += 0.5f * even.value + q * even.slope;
      third += r * (even.slope + (4 / 3.0f) * q * even.bend);
    }
    EACH u[i] += row[0] * v[i];
    EACH v[i] -= u[i] * (first + u[i] * (second + u[i] * third));
  }
  EACH at[2 * i] = u[i] + last * v[i];
  EACH at[2 * i + 1] = decay * v[i];
}

void kz_processed_displaced(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay, const float *angle,
                            float *by) {
  if (mirrored)
    run(true, n_stages, row, last, decay, angle, by);
  else
    run(false, n_stages, row, last, decay, angle, by);
}
