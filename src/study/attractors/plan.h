/* Plan of the study `attractors`. The counts of the axes are not used. */
#pragma once

#include "kapitza/study.h"

struct kz_attractors_plan {
  kz_axis theta, velocity;
  int64_t starts, max_period, seed;
};
