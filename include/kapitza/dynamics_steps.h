/* dynamics, steps: the error of one drive period (Fortran; layer 1). */
#pragma once

#include "kapitza/dynamics.h"

/* Errors of one drive period, measured on a few thousand states before cells are labelled. Not collective. */

/* error [n] = upper estimate of the error of one drive period, in rad: error[c] for states of the whole circle with
 * speeds from speed[c] to speed[c + 1] (rad per drive radian; speed [n + 1] ascends). It is twice the largest
 * difference that doubling the steps makes on 512 states; very large if a state diverges. */
void kz_step_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *speed,
                    double *error);

/* Largest error of one period by the map table, interpolated over `points` nodes an axis, rad. Needs a full table. */
double kz_dynamics_table_error(kz_dynamics *dynamics, int32_t points);
