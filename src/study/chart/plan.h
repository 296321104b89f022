/* What a scene says of the study `chart`: ends of the same starts over a plane of two keys of the pendulum mapping. */
#ifndef KAPITZA_STUDY_CHART_PLAN_H
#define KAPITZA_STUDY_CHART_PLAN_H

#include "kapitza/study.h"

enum { KZ_CHART_MOST_PERIOD = 64 };
struct kz_chart_plan {
  kz_chart_axis x, y;
  kz_reals theta, velocity;        /* starts: rad, rad per drive radian; a single velocity belongs to all angles */
  int64_t max_period, max_periods; /* max_periods INT64_MIN = not given */
};

#endif
