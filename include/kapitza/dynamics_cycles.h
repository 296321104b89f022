/* dynamics, cycles: one cycle, attracting or not, and what is known of it (Fortran; layer 1). */
#pragma once

#include "kapitza/dynamics.h"

/* Finds the cycle near a state by Newton's method on the strobe map of `numerics`; n = a period after which it closes.
 * The cycle need not attract. cycle->period = its smallest period, or 0 if none lies within `max_distance` (rad). theta
 * (rad) and velocity [n], in: the first is the state; out: the cycle's strobe points, that near the state first. Of
 * *cycle all is known but symmetry, mirror image and exponent. */
void kz_dynamics_close_cycle(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, double max_distance,
                             double *theta, double *velocity, kz_attractor *cycle);

/* One cycle of the stroboscopic map, attracting or not; kapitza/dynamics_curves.h follows it from one pendulum to
 * another.
 *
 * Angles in rad from the DOWN position, velocities in rad per drive radian. The map is the one of published values
 * (split6, 96 steps or more), whatever the scene's numerics. Nothing here is collective. */

/* Maps of up to n >= 1 pendulums, the oldest are dropped: their tables cost more than a short cycle. Not
 * thread-safe. */
typedef struct kz_fine_maps kz_fine_maps;
kz_fine_maps *kz_fine_maps_create(int64_t n);
void kz_fine_maps_free(kz_fine_maps *maps);

/* Sets everything of a cycle from its period and symmetry, and n strobe points, state [n][2], equally far apart in the
 * order of time (a part of its period, 64 at most): the more there are, the faster it goes. maps: where maps are kept;
 * NULL = each is made anew. */
void kz_branch_describe(kz_fine_maps *maps, const kz_pendulum *pendulum, int64_t n, const double *state,
                        kz_attractor *point);

/* Whether a and b are one cycle at the same parameters: one is among the strobe points of the other. maps: as above. */
int32_t kz_branch_same(kz_fine_maps *maps, const kz_pendulum *pendulum, const kz_attractor *a, const kz_attractor *b);

/* The centre of a motion (KZ_ABOUT_DOWN ...) from samples of its angle, theta [n] (rad, not wrapped), and whether it
 * rotates: down or inverted where it stays within pi of it and its mean within pi/4. *origin = the copy of this
 * position, rad; 0 for other motions. */
int32_t kz_centre_of(int32_t rotates, int64_t n, const double *theta, double *origin);
