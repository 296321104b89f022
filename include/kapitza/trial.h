/* trial: what the numerics can carry, measured on a few hundred states before anything is labelled (Fortran; floor 1, dynamics).
 * Nothing here is collective. */
#ifndef KAPITZA_TRIAL_H
#define KAPITZA_TRIAL_H

#include <stdint.h>

#include "kapitza/dynamics.h"

/* error [n]: the largest error of one drive period, by step doubling, among states with speeds from speed[c] to speed[c + 1]
 * (rad per drive radian, speed [n + 1] ascending), whole circle; rad. Huge where a state diverges. Double precision at most. */
void kz_trial_step_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *speed,
                          double *error);

/* The largest error of one period of the map table (`points` nodes an axis), rad. Needs the table. */
double kz_dynamics_table_defect(kz_dynamics *dynamics, int32_t points);

#endif
