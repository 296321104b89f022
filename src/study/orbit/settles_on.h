/* Where a motion of the pendulum ends. */
#ifndef KAPITZA_STUDY_SETTLES_ON_H
#define KAPITZA_STUDY_SETTLES_ON_H

#include "orbit/motion.h"

/* Writes the name of the attractor that the pendulum settles on from a state to name [KZ_NAME_LENGTH]; "" if there is no attractor, or if it
 * has not settled within the periods that the damping needs (at most a million steps). `fastest` = a velocity that the motion reaches, rad
 * per drive radian. */
kz_status kz_settles_on(const kz_model *model, kz_state state, double fastest, char *name);

#endif
