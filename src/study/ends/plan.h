/* Plan of the measure `ends` of a sweep: starts that are the same at every point of a plane. */
#pragma once

#include "kapitza/study.h"

enum { KZ_ENDS_MOST_PERIOD = 64 };
struct kz_ends_plan {
  kz_reals theta, velocity;        /* rad, rad per drive radian; a single velocity belongs to all angles */
  int64_t max_period, max_periods; /* max_periods INT64_MIN = not given */
};
