/* The derivative of a period of the processed splitting in single precision, which is enough for an error: from the
 * reduced angles at every kick, which the loop of the states keeps (stages.c). */
#include <stdbool.h>

#include "stages.h"

#if defined __AVX512F__
enum { VECTOR_BYTES = 64, CHAINS = 4 };
#else
enum { VECTOR_BYTES = 32, CHAINS = 2 };
#endif
/* Lanes of a vector, and coefficients of a slope (stages.f90). */
enum { LANES = VECTOR_BYTES / 4, TERMS = 5 };
#define EACH _Pragma("GCC unroll 4") for (int i = 0; i < CHAINS; i++)

typedef float vector __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(float)), may_alias));

static void store(float *to, const vector *x) {
  EACH *(vector *)(to + i * LANES) = x[i];
}

static inline __attribute__((always_inline)) void run(bool mirrored, int64_t n_stages, const float *row, float last,
                                                      float decay, const float *kept, int64_t n, float *c) {
  for (int64_t first = 0; first < n; first += CHAINS * LANES) {
    const float *r = row, *x = kept + first;
    vector uu[CHAINS], uv[CHAINS], vu[CHAINS], vv[CHAINS], p[CHAINS], q[CHAINS], e[CHAINS];
    EACH uu[i] = vv[i] = 1 + (vector){0};
    EACH uv[i] = vu[i] = (vector){0};
    for (int64_t s = 0; s < n_stages; s++, r += 1 + 2 * TERMS, x += KZ_LANES) {
      EACH uu[i] += r[0] * vu[i];
      EACH uv[i] += r[0] * vv[i];
      EACH q[i] = *(const vector *)(x + i * LANES) * *(const vector *)(x + i * LANES);
      EACH p[i] = r[TERMS] + (vector){0};
      for (int j = TERMS - 1; j >= 1; j--) EACH p[i] = p[i] * q[i] + r[j];
      if (!mirrored) {
        EACH e[i] = r[2 * TERMS] + (vector){0};
        for (int j = 2 * TERMS - 1; j > TERMS; j--) EACH e[i] = e[i] * q[i] + r[j];
        EACH p[i] += e[i] * *(const vector *)(x + i * LANES);
      }
      EACH vu[i] -= p[i] * uu[i];
      EACH vv[i] -= p[i] * uv[i];
    }
    EACH uu[i] += last * vu[i];
    EACH uv[i] += last * vv[i];
    EACH vu[i] *= decay;
    EACH vv[i] *= decay;
    store(c + first, uu);
    store(c + KZ_LANES + first, uv);
    store(c + 2 * KZ_LANES + first, vu);
    store(c + 3 * KZ_LANES + first, vv);
  }
}

void kz_processed_tangents(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay, const float *kept,
                           int64_t n, float *c) {
  if (mirrored)
    run(true, n_stages, row, last, decay, kept, n, c);
  else
    run(false, n_stages, row, last, decay, kept, n, c);
}
