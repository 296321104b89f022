/* Where a motion of the pendulum ends. */
#ifndef KAPITZA_STUDY_SETTLES_ON_H
#define KAPITZA_STUDY_SETTLES_ON_H

#include "orbit/motion.h"

/* The name of the attractor that the pendulum settles on from a state, into name [KZ_NAME_LENGTH]; empty where nothing attracts,
 * or where it has not settled after as many periods as the damping needs (at most a million steps). `fastest` = a velocity that
 * the motion reaches. */
kz_status kz_settles_on(const kz_model *model, kz_state state, double fastest, char *name);

#endif
