/* One drive period in pairs of doubles: tables that pairs.f90 makes, loops in C. */
#ifndef KAPITZA_PAIRS_H
#define KAPITZA_PAIRS_H

#include <stdint.h>

#include "lanes/lanes.h"

/* Angles (half-turns) and velocities (rad per drive radian), each high + low. */
typedef struct {
  double u[2][KZ_LANES];
  double v[2][KZ_LANES];
} kz_pair_lanes;

/* The stages of one period and the wrap of the angles to [-1, 1]; turns [n]: the net number of turns. row [n_stages + 1][n_row]: of
 * each stage, the drift's coefficients (high and low of the first, n_drift - 1 doubles) and the kick's (n_pairs high and low, n_kick -
 * n_pairs doubles), those of high powers being too small for more; of the last row the drift alone. ordered
 * [n_stages]: whether the modulus of every coefficient of a kick that is a pair is at least the sum of those after it. decay [2]: what
 * is left of the velocity that the stages carry. Without mirror symmetry a row goes on with as many coefficients, those of even
 * polynomials: table_types.inc. */
void kz_pairs_stages(int32_t mirrored, int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs, const double *row,
                     const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns);

/* Half the order of the series: harmonics and powers of a displacement; terms of the sine. */
enum { KZ_HALF_ORDER = 7, KZ_SINE_TERMS = 15 };

/* A displacement of (u, v): of each variable, for the harmonics j = 0 .. KZ_HALF_ORDER - 1, sin(pi j u) times even powers of v and cos(pi j u)
 * times odd ones, up to 2 (KZ_HALF_ORDER - max(j, 1)); the second of `parts`, which mirrored pendulums have not, cosine with even and
 * sine with odd ones. Coefficients are high and low; the first `pairs` of them need both. */
typedef struct {
  double coefficient[2][2][KZ_HALF_ORDER][2][KZ_HALF_ORDER][2];
  int64_t pairs[2][2][KZ_HALF_ORDER][2];
  int64_t parts;
  double sine[KZ_SINE_TERMS][2]; /* sin(pi r)/r in powers of r^2 for |r| <= 1/2 */
  int64_t sine_pairs;
} kz_displacement;

/* (u, v) of the lanes 0 .. n - 1 += the displacement there. */
void kz_pairs_displace(const kz_displacement *displacement, int64_t n, kz_pair_lanes *lanes);

#endif
