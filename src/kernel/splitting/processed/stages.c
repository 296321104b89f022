/* The inner loop of the processed splitting, in the compilers' vector types because gfortran does not keep the states
 * in registers (1.5 times slower). Several vectors at once hide the latency of the arithmetic. Operations per lane and
 * kick: n_drift + 1 of a drift, 3 of the reduction to the nearest even half-turn, n_kick + 2 of an odd polynomial;
 * without mirror symmetry n_drift + n_kick more of even polynomials. */
#include "vector/vector.h"

#include <stddef.h>

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 1
#error "the processed splitting is made for fused operations: -ffp-contract=fast (cmake/Compilers.cmake)"
#endif

/* Largest number of vectors at once; wasm keeps no more of them in registers. */
#ifdef __wasm__
enum { CHAINS = 4 };
#else
enum { CHAINS = 8 };
#endif
#define EACH _Pragma("GCC unroll 8") for (int i = 0; i < IN(CHAINS); i++)

typedef float narrow __attribute__((vector_size(VECTOR_BYTES / 2), aligned(sizeof(float)), may_alias));
typedef float floats __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(float)), may_alias));

#define NUMBER double
#define VECTOR vector
#define NARROW narrow
#define ROUND_TO_EVEN 0x3p52
#define IN(name) double_##name
#include "stages.inc"

#define NUMBER float
#define VECTOR floats
#define NARROW floats
#define ROUND_TO_EVEN 0x3p23f
#define IN(name) single_##name
#include "stages.inc"

/* Does all drifts and kicks of a period. u (half-turns) and v (velocity times exp(beta t)) have KZ_LANES lanes; the
 * first n lanes move, and further ones up to a whole block. row [n_stages][n_drift + n_kick]: coefficients of a drift
 * and a kick; twice as many without mirror symmetry (tables.inc). kept [n_stages][KZ_LANES], or NULL: the reduced
 * angles at the kicks, from which tangents.c computes the derivative and the motion of neighbours. */
void kz_processed_kicks(int32_t mirrored, int32_t n_drift, int32_t n_kick, int64_t n_stages, const double *row,
                        int64_t n, double *u, double *v, float *kept) {
  if (mirrored)
    double_run_stages(true, n_drift, n_kick, n_stages, row, n, u, v, kept);
  else
    double_run_stages(false, n_drift, n_kick, n_stages, row, n, u, v, kept);
}

/* kz_processed_kicks in single precision, without angles: for motions that errors of 1e-6 rad do not decide. */
void kz_processed_kicks_single(int32_t mirrored, int32_t n_drift, int32_t n_kick, int64_t n_stages, const float *row,
                               int64_t n, double *u, double *v) {
  float a[KZ_LANES], b[KZ_LANES];
  for (int i = 0; i < KZ_LANES; i++) a[i] = (float)u[i];
  for (int i = 0; i < KZ_LANES; i++) b[i] = (float)v[i];
  if (mirrored)
    single_run_stages(true, n_drift, n_kick, n_stages, row, n, a, b, NULL);
  else
    single_run_stages(false, n_drift, n_kick, n_stages, row, n, a, b, NULL);
  for (int i = 0; i < KZ_LANES; i++) u[i] = a[i];
  for (int i = 0; i < KZ_LANES; i++) v[i] = b[i];
}
