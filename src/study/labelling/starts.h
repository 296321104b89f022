/* Starts in physical units followed by direct integration. Not collective. */
#ifndef KAPITZA_STUDY_STARTS_H
#define KAPITZA_STUDY_STARTS_H

#include "kapitza/dynamics.h"

/* Where n starts [n][2] (rad, rad per drive radian) end: end [n] = number of kz_dynamics, 0 = not settled; periods [n] until then. */
void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);

#endif
