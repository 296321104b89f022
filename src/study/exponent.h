/* The largest Lyapunov exponent of one motion. */
#ifndef KAPITZA_STUDY_EXPONENT_H
#define KAPITZA_STUDY_EXPONENT_H

#include "motion.h"

/* Mean growth of a small deviation per drive period over a record of the pendulum, by the tangent map, and its standard error
 * from blocks of the record; NaN where the record is too short for blocks. */
void kz_exponent_along(const kz_mover *mover, int64_t periods, kz_state start, double *mean, double *error);

#endif
