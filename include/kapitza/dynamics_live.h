/* dynamics: for pictures that move (Fortran; layer 1, a part of dynamics). */
#pragma once

#include "kapitza/dynamics.h"

/* The dynamics of a nearby pendulum, made from `dynamics`; free it too. `error`: that its map may have beside that of
 * its steps, rad, > 0. Newton's method continues the cycles; a chaotic attractor stays where no orbit on it is trapped.
 * The trapping regions are the old ones without their outermost cells, so it is only likely that they trap: they are
 * for moving pictures, until kz_dynamics_fine_regions makes new ones. *lost = number of attractors that could not be
 * continued, mirror images not counted. */
kz_dynamics *kz_dynamics_continue(const kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_numerics *numerics,
                                  double error, int64_t *lost);

/* Extends the regions by n orbits: state [n][2] physical starts, each followed until it is trapped, for `most` periods
 * at most, all together for `budget`. A cell joins an attractor if all orbits that visited it end there, and visited
 * only such cells from then on. It is only likely that such cells trap: they are for moving pictures of weakly damped
 * pendulums, whose regions do not grow. */
void kz_dynamics_learn_regions(kz_dynamics *dynamics, int64_t n, const double *state, int64_t most, int64_t budget);

/* Moves n states, state [n][2] = half-turns in [-1, 1] and velocity, by one period of the scene's map. Not
 * thread-safe. */
void kz_dynamics_advance(kz_dynamics *dynamics, int64_t n, double *state);

/* Settling times that vary smoothly with the start, for pictures: time [n], in drive periods, at which the motions come
 * into the trapping ellipse of a strobe point of their attractor, interpolated by its exponent. Motions have label [n]
 * and are at state [n][2], as kz_dynamics_follow leaves them, after time [n] periods, in and out. The time stays as it
 * is where no ellipse of an attractor holds a motion after 200 more. */
void kz_dynamics_smooth_times(kz_dynamics *dynamics, int64_t n, const int32_t *engine_label, const double *state,
                              double *time);
