/* settling: how long motions take to settle, from the damping alone (C; study). Not collective. */
#ifndef KAPITZA_STUDY_SETTLING_H
#define KAPITZA_STUDY_SETTLING_H

#include "kapitza/study.h"

/* Drive periods that a motion takes on the average until it is trapped; beta > 0. */
double kz_settling_mean(double beta);

#endif
