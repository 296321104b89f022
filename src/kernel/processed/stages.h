/* The vectors' loops of the processed splitting (stages.f90 and processor.f90 call them). */
#ifndef KAPITZA_KERNEL_STAGES_H
#define KAPITZA_KERNEL_STAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "lanes/lanes.h"

#if defined __AVX512F__
enum { VECTOR_BYTES = 64 };
#else
enum { VECTOR_BYTES = 32 };
#endif
typedef double vector __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(double)), may_alias));

#define OPERATION static inline __attribute__((always_inline))

/* Does all drifts and kicks of a period. u (half-turns) and v (velocity times exp(beta t)) have KZ_LANES lanes; the first n lanes move, and
 * further ones up to a whole block. row [n_stages][n_drift + n_kick]: coefficients of a drift and a kick; twice as many without mirror
 * symmetry (tables.inc). kept [n_stages][KZ_LANES], or NULL: the reduced angles at the kicks, from which tangents.c computes the
 * derivative and the motion of neighbours. */
void kz_processed_kicks(int32_t mirrored, int32_t n_drift, int32_t n_kick, int64_t n_stages, const double *row, int64_t n,
                        double *u, double *v, float *kept);

/* Computes the derivative of a period in single precision. row [n_stages][1 + 5 + 5]: a drift, the slope of a kick as a polynomial of the
 * square of the angle, and a second polynomial, times the angle, for pendulums without mirror symmetry; last = the last drift. c
 * [4][KZ_LANES] = d(u, v)/d(u0, v0), row by row. */
void kz_processed_tangents(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay, const float *kept,
                           int64_t n, float *c);

/* Orbits whose neighbours are moved together, and neighbours of each: GROUP and POINTS of stages.f90. */
enum { KZ_GROUP = 16, KZ_POINTS = 6 };

/* How neighbours of orbits move in a period, relative to the orbits, in single precision. angle [n_stages][KZ_GROUP]: those of the orbits at the
 * kicks; row, last, decay: as above. by [KZ_POINTS][2][KZ_GROUP], in and out: what the angles (half-turns) and velocities differ by. */
void kz_processed_displaced(int32_t mirrored, int64_t n_stages, const float *row, float last, float decay, const float *angle,
                            float *by);

/* The order of the doubles' series and its harmonics: series_r64.f90, series.inc. */
enum { KZ_ORDER = 14, KZ_HARMONICS_KEPT = KZ_ORDER / 2 };

/* (u, v) + processor(u, v), in whole blocks of lanes like kz_processed_kicks. theta, velocity [2][KZ_ORDER + 1][KZ_HARMONICS_KEPT + 1]: processor_t of
 * tables.inc. sine, cosine: of pi u. */
void kz_processed_change(int32_t mirrored, const double *theta, const double *velocity, int64_t n, const double *sine,
                         const double *cosine, double *u, double *v);

#endif
