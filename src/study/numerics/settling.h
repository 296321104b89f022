/* settling: how long motions take to settle, from the damping alone (C; study). Not collective. */
#ifndef KAPITZA_STUDY_SETTLING_H
#define KAPITZA_STUDY_SETTLING_H

#include "kapitza/study.h"

/* Drive periods that a motion takes on the average until it is trapped; beta > 0. */
double kz_settling_mean(double beta);

/* Seconds of one core for the search for attractors from so many starts; period: seconds of one state's drive period with the
 * scene's steps, max_periods: after which a start counts as not settled. */
double kz_settling_search(const kz_pendulum *pendulum, double starts, double period, int64_t max_periods);

/* Drive periods that a cell of a basin is followed on the average: regions that grow over the map table trap it sooner. 0 without
 * damping. */
double kz_settling_cells(double beta, int64_t max_periods);

#endif
