/* step_error: errors of one drive period, measured on a few thousand states before anything is labelled (Fortran; layer 1,
 * dynamics). Nothing here is collective. */
#ifndef KAPITZA_STEP_ERROR_H
#define KAPITZA_STEP_ERROR_H

#include <stdint.h>

#include "kapitza/dynamics.h"

/* error [n]: an upper estimate of the error of one drive period, by step doubling, for states with speeds from speed[c] to
 * speed[c + 1] (rad per drive radian, speed [n + 1] ascending), whole circle; rad: twice the largest of 512 states. Huge where a
 * state diverges. Double precision at most. */
void kz_step_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *speed, double *error);

/* The largest error of one period of the map table (`points` nodes an axis), rad. Needs the table. */
double kz_dynamics_table_defect(kz_dynamics *dynamics, int32_t points);

#endif
