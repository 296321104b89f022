/* settling: how long motions take to settle, estimated from the damping (C; study). Not collective. */
#ifndef KAPITZA_STUDY_SETTLING_H
#define KAPITZA_STUDY_SETTLING_H

#include "kapitza/study.h"

/* Mean number of drive periods until a motion is trapped; beta > 0. */
double kz_settling_mean(double beta);

#endif
