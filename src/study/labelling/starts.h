/* Starts in physical units labelled. Not collective. */
#ifndef KAPITZA_STUDY_STARTS_H
#define KAPITZA_STUDY_STARTS_H

#include "kapitza/dynamics.h"

/* Where n starts [n][2] (rad, rad per drive radian) end by direct integration: end [n] = number of kz_dynamics, 0 = not settled; periods [n]
 * until then. */
void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);
/* The same, decided by the precision levels; what none of them decides ends where direct integration puts it. */
void kz_decide_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);

/* Takes n starts from their release to the strobe from which labels follow them; state [n][2] then: half-turns, velocity. */
void kz_released_states(kz_dynamics *dynamics, int64_t n, kz_start *start, double *state);

#endif
