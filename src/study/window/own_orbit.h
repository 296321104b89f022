/* Follows one start in as many digits as its label needs. Not collective. */
#ifndef KAPITZA_STUDY_OWN_ORBIT_H
#define KAPITZA_STUDY_OWN_ORBIT_H

#include <stdint.h>

#include "kapitza/dynamics.h"

/* Follows the start in more and more digits until double or quad precision decides the rest of its motion. decision->label = number of an attractor;
 * 0 = not settled within max_periods; KZ_DOUBTFUL = undecided even with 10,000 bits, or with the most bits of the build. */
kz_status kz_own_orbit_decide(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate start[2],
                              int64_t max_periods, kz_decision *decision);

#endif
