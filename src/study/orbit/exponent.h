/* The largest Lyapunov exponent of one motion. */
#ifndef KAPITZA_STUDY_EXPONENT_H
#define KAPITZA_STUDY_EXPONENT_H

#include "motion.h"

/* *mean = mean of the logarithm of the growth of a small deviation per drive period, along a record of the pendulum, by the tangent map;
 * *error = its standard error from blocks of the record; NaN if the record is too short for blocks. */
void kz_exponent_along(const kz_model *model, int64_t periods, kz_state start, double *mean, double *error);

/* True if a mean exponent is positive by five standard errors. */
bool kz_exponent_positive(double mean, double error);

/* True if the exponent of the orbit from `start` on is still positive by five standard errors. `mean` is the exponent of its past; it gives
 * the number of periods, so many that an orbit near an unstable cycle has left it. False if that is more than 100,000 periods. */
bool kz_exponent_stays_positive(const kz_model *model, kz_state start, double mean);

#endif
