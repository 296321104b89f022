/* One start followed in as many digits as decide where it ends. Not collective. */
#ifndef KAPITZA_STUDY_OWN_ORBIT_H
#define KAPITZA_STUDY_OWN_ORBIT_H

#include <stdint.h>

#include "kapitza/dynamics.h"

/* Follows the start in ever more digits until what is left of its motion is decided in double precision: decision->label = number of an
 * attractor, 0 where it has not settled within max_periods; KZ_DOUBTFUL where even 10,000 bits, or all that there are, do not decide. */
kz_status kz_own_orbit_decide(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate start[2],
                              int64_t max_periods, kz_decision *decision);

#endif
