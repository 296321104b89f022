/* What a scene says of the study `attractors`. The counts of the axes are not used. */
#ifndef KAPITZA_STUDY_ATTRACTORS_PLAN_H
#define KAPITZA_STUDY_ATTRACTORS_PLAN_H

#include "kapitza/study.h"

struct kz_attractors_plan {
  kz_axis theta, velocity;
  int64_t starts, max_period, seed;
};

#endif
