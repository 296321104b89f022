/* What a scene says of the study `potential`. */
#ifndef KAPITZA_STUDY_POTENTIAL_PLAN_H
#define KAPITZA_STUDY_POTENTIAL_PLAN_H

#include "kapitza/study.h"

struct kz_potential_plan {
  kz_reals drive_amplitudes;
  int64_t theta_count;
};

#endif
