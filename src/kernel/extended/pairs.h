/* One drive period in pairs of doubles. pairs.f90 makes the tables; the loops are in C. */
#ifndef KAPITZA_PAIRS_H
#define KAPITZA_PAIRS_H

#include <stdint.h>

#include "lanes/lanes.h"

/* Angles (half-turns) and velocities (rad per drive radian), each high + low. */
typedef struct {
  double u[2][KZ_LANES];
  double v[2][KZ_LANES];
} kz_pair_lanes;

/* Does the stages of one period and wraps the angles to [-1, 1]; turns [n] = the net number of turns. row [n_stages + 1][n_row]: for each
 * stage the coefficients of the drift (the first one high and low, then n_drift - 1 doubles) and of the kick (n_pairs high and low, then
 * n_kick - n_pairs doubles, because those of high powers are small); in the last row only the drift counts. ordered [n_stages]: 1 if the
 * modulus of every pair among the coefficients of the kick is at least the sum of the moduli after it. decay [2]: factor of the velocity,
 * high and low, from damping. Without mirror symmetry a row goes on with as many coefficients of even polynomials (tables.inc). */
void kz_pairs_stages(int32_t mirrored, int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs, const double *row,
                     const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns);

/* Half the order of the series, which bounds harmonics and powers of a displacement; number of terms of the sine. */
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

/* Adds the displacement to (u, v) of the lanes 0 .. n - 1. */
void kz_pairs_displace(const kz_displacement *displacement, int64_t n, kz_pair_lanes *lanes);

#endif
