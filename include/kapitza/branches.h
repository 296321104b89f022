/* branches: one cycle of the stroboscopic map carried from parameters to parameters (Fortran; layer 1, folder dynamics).
 *
 * Angles in rad from the DOWN position, velocities in rad per drive radian. The map is the one of published values (split6, 96
 * steps or more), whatever the scene's numerics. Nothing here is collective. */
#ifndef KAPITZA_BRANCHES_H
#define KAPITZA_BRANCHES_H

#include <stdint.h>

#include "kapitza/kernel.h"

/* A cycle at one value of the parameters. */
typedef struct {
  double theta, velocity;                    /* the strobe point that is followed; theta in [-pi, pi] */
  double amplitude;                          /* rad from its centre over continuous time; 0 for rotations */
  double multiplier_re[2], multiplier_im[2]; /* over the period: larger modulus first, + imaginary first */
  double half_re[2], half_im[2]; /* of the half map x -> -F^(n/2)(x) of a symmetric cycle (n = 1: -F); of the map F^n else */
  double halves_distance; /* rad, between strobe points half a period apart, the nearest pair; HUGE_VAL for odd periods */
  double mirror_distance; /* rad, between the cycle and its mirror image: the strobe point's nearest; 0 if symmetric */
  int32_t period, winding, centre, symmetric; /* centre: 0 down, 1 inverted, 2 rotating, 3 none of these */
} kz_branch_point;

/* The cycle of `pendulum` that continues `from` (whose point, period, winding and symmetry count): Newton's method from its
 * strobe point, each step at most half the last one, which keeps it from leaving for another cycle; symmetric cycles are solved
 * on the half map (BSG's flutter: -F(x) = x). Returns 1 where one of the same period, winding and symmetry lies within
 * `max_distance` rad, else 0 and *to is undefined. It need not attract. from == to is allowed. */
int32_t kz_branch_continue(const kz_pendulum *pendulum, const kz_branch_point *from, double max_distance, kz_branch_point *to);

/* Whether a and b are the same cycle at the same parameters: one is among the strobe points of the other. */
int32_t kz_branch_same(const kz_pendulum *pendulum, const kz_branch_point *a, const kz_branch_point *b);

#endif
