/* Labels of starts in rad and rad per drive radian. Not collective. */
#ifndef KAPITZA_STUDY_STARTS_H
#define KAPITZA_STUDY_STARTS_H

#include "kapitza/dynamics.h"

/* Follows n starts, start [n][2] (rad, rad per drive radian), by direct integration. end [n] = number of the attractor in kz_dynamics, 0 = not
 * settled; periods [n] = drive periods until then. */
void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);
/* The same by the precision levels. A start that no level decides gets the end by direct integration. */
void kz_decide_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);

/* Moves n starts from their release to the strobe at which labelling begins. state [n][2] = half-turns and velocity there. */
void kz_released_states(kz_dynamics *dynamics, int64_t n, kz_start *start, double *state);

#endif
