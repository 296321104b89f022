/* The inner loop of the processed splitting. Written with the compilers' vector types because gfortran does not keep the states
 * in registers (1.5 times slower). Several vectors at once hide the latency of the arithmetic. Operations per lane and kick: a
 * drift (n_drift + 1), the reduction to the nearest even half-turn (3), an odd polynomial (n_kick + 2); without mirror symmetry even
 * polynomials too (n_drift, n_kick). */
#include "vector/vector.h"

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 1
#error "the processed splitting is made for fused operations: -ffp-contract=fast (cmake/Compilers.cmake)"
#endif

/* Lanes of a vector, and vectors at once. */
enum { LANES = VECTOR_BYTES / 8, CHAINS = 8 };
#define EACH _Pragma("GCC unroll 8") for (int i = 0; i < CHAINS; i++)
static const double round_to_even = 0x3p52; /* adding it rounds to an even integer */

typedef float narrow __attribute__((vector_size(VECTOR_BYTES / 2), aligned(sizeof(float)), may_alias));

/* c[0] + c[1] q + .. */
OPERATION void polynomial(int n, const double *c, const vector *q, vector *p) {
  EACH p[i] = c[n - 1] + (vector){0};
  for (int j = n - 2; j >= 0; j--) EACH p[i] = p[i] * q[i] + c[j];
}

/* kept: into it go the reduced angles at each kick, KZ_LANES a stage, if it is not NULL. */
OPERATION void block(bool mirrored, int n_drift, int n_kick, int64_t n_stages, const double *restrict row, vector *u, vector *v,
                     float *restrict kept) {
  vector a[CHAINS], b[CHAINS], r[CHAINS], q[CHAINS], p[CHAINS];
  const int n = n_drift + n_kick;
  EACH a[i] = u[i];
  EACH b[i] = v[i];
  for (int64_t s = 0; s < n_stages; s++, row += mirrored ? n : 2 * n) {
    EACH q[i] = b[i] * b[i];
    polynomial(n_drift, row, q, p);
    EACH a[i] += p[i] * b[i];
    if (!mirrored) {
      polynomial(n_drift, row + n, q, p);
      EACH a[i] += p[i];
    }
    EACH r[i] = a[i] - ((a[i] + round_to_even) - round_to_even);
    EACH q[i] = r[i] * r[i];
    if (kept) {
      EACH *(narrow *)(kept + i * LANES) = __builtin_convertvector(r[i], narrow);
      kept += KZ_LANES;
    }
    EACH p[i] = row[n_drift + n_kick - 1] * q[i] + row[n_drift + n_kick - 2];
    for (int j = n_kick - 3; j >= 0; j--) EACH p[i] = p[i] * q[i] + row[n_drift + j];
    EACH r[i] -= r[i] * q[i];
    EACH b[i] -= r[i] * p[i];
    if (!mirrored) {
      polynomial(n_kick, row + n + n_drift, q, p);
      EACH b[i] -= p[i];
    }
  }
  EACH u[i] = a[i];
  EACH v[i] = b[i];
}

#define ALL(D, K)                                 \
  for (int64_t i = 0; i < n; i += CHAINS * LANES) \
  block(mirrored, D, K, n_stages, row, (vector *)(u + i), (vector *)(v + i), kept ? kept + i : 0)
#define CASE(D, K)     \
  case 16 * (D) + (K): \
    ALL(D, K);         \
    break;
#define CASES(K) CASE(1, K) CASE(2, K) CASE(3, K) CASE(4, K)

/* `mirrored` is a constant where it is called: each kind of pendulum has loops of its own. */
OPERATION void run(bool mirrored, int32_t n_drift, int32_t n_kick, int64_t n_stages, const double *row, int64_t n, double *u,
                   double *v, float *kept) {
#ifdef __SANITIZE_ADDRESS__ /* one body for all lengths: the checks of 32 take a minute to compile */
  ALL(n_drift, n_kick);
#else
  switch (16 * n_drift + n_kick) { CASES(4) CASES(5) CASES(6) CASES(7) CASES(8) CASES(9) CASES(10) CASES(11) }
#endif
}

/* Does all drifts and kicks of a period. u (half-turns) and v (velocity times exp(beta t)) have KZ_LANES lanes; the first n lanes move, and
 * further ones up to a whole block. row [n_stages][n_drift + n_kick]: coefficients of a drift and a kick; twice as many without mirror
 * symmetry (tables.inc). kept [n_stages][KZ_LANES], or NULL: the reduced angles at the kicks, from which tangents.c computes the
 * derivative and the motion of neighbours. */
void kz_processed_kicks(int32_t mirrored, int32_t n_drift, int32_t n_kick, int64_t n_stages, const double *row, int64_t n,
                        double *u, double *v, float *kept) {
  if (mirrored)
    run(true, n_drift, n_kick, n_stages, row, n, u, v, kept);
  else
    run(false, n_drift, n_kick, n_stages, row, n, u, v, kept);
}
