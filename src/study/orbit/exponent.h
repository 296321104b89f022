/* The largest Lyapunov exponent of one motion. */
#ifndef KAPITZA_STUDY_EXPONENT_H
#define KAPITZA_STUDY_EXPONENT_H

#include "motion.h"

/* Mean growth of a small deviation per drive period over a record of the pendulum, by the tangent map, and its standard error
 * from blocks of the record; NaN where the record is too short for blocks. */
void kz_exponent_along(const kz_model *model, int64_t periods, kz_state start, double *mean, double *error);

/* Whether a mean exponent is positive beyond doubt: by five standard errors. */
bool kz_exponent_positive(double mean, double error);

/* Whether neighbours of the orbit from `start` go on parting with the exponent `mean` of its past: positive by five standard
 * errors, over so many periods that an orbit which only leaves an unstable cycle has left it. False where that takes more than
 * 100,000 periods. */
bool kz_exponent_stays_positive(const kz_model *model, kz_state start, double mean);

#endif
