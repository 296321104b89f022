/* The stages of a period of the processed splitting (stages.f90 calls them). */
#ifndef KAPITZA_KERNEL_STAGES_H
#define KAPITZA_KERNEL_STAGES_H

#include <stdint.h>

/* All drifts and kicks of a period, in whole blocks of lanes: u (half-turns) and v (velocity times exp(beta t)) have 64 lanes,
 * of which n and some more move. row [n_stages][n_drift + n_kick]: the coefficients of a drift and a kick. */
void kz_processed_kicks(int32_t n_drift, int32_t n_kick, int64_t n_stages, const double *row, int64_t n, double *u, double *v);

#endif
