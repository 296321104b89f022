/* settling: how long motions take to settle, from the damping alone (C; layer 3, study). Not collective. */
#ifndef KAPITZA_SETTLING_H
#define KAPITZA_SETTLING_H

#include "kapitza/study.h"

/* Drive periods that a motion takes on the average until it is trapped; beta > 0. */
double kz_settling_mean(double beta);

/* Drive periods after which nearly all motions are trapped, at least 2000. Where that would be more than a million, 2000 too. */
int64_t kz_settling_periods(double beta);

/* The same for the weakest damping of a scene: that of its pendulum and of its sweep. */
int64_t kz_settling_scene(const kz_scene *scene);

/* Seconds of one core for the search for attractors from so many starts; period: seconds of one state's drive period with the
 * scene's steps, max_periods: after which a start counts as not settled. */
double kz_settling_search(const kz_pendulum *pendulum, double starts, double period, int64_t max_periods);

/* Drive periods that a cell of a basin is followed on the average: regions that grow over the map table trap it sooner. 0 without
 * damping. */
double kz_settling_cells(double beta, int64_t max_periods);

/* A line for each study whose max_periods leaves most motions unsettled. It begins with the key to change. */
void kz_settling_warn(const kz_scene *scene, FILE *out);

#endif
