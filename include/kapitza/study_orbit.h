/* Plan of the study `orbit`. Values that are not given: NaN (start), INT64_MIN (attractor, periods, period). */
#pragma once

#include "kapitza/study.h"

struct kz_orbit_plan {
  double theta, velocity; /* start */
  int64_t attractor;      /* id in the catalogue of the same scene, instead of a start */
  int32_t model;          /* KZ_PENDULUM, KZ_MATHIEU, KZ_EFFECTIVE */
  int32_t about;          /* position of the model mathieu: 0 down, 1 inverted */
  int64_t transient;      /* drive periods before the record */
  int64_t periods;        /* Periods of the record */
  int64_t samples_per_period;
  bool closed;
  int64_t period; /* Period of a closed orbit; not given = the program finds it */
};
