/* Plans of the parts `release` and `ramp` of the study basin, and of the measure `phases` of a sweep. */
#pragma once

#include "kapitza/study.h"

struct kz_release_plan {
  double start_phase; /* phase of the drive at the release of the cells, rad; NaN = 0 */
  int64_t phases;     /* number of phases at which the cells are also released; 0 or less = none */
};

/* The quantity that a ramp changes, and its form in time. */
typedef enum { KZ_RAMP_DAMPING = 0, KZ_RAMP_DRIVE = 1 } kz_ramp_key;
typedef enum { KZ_RAMP_LINEAR = 0, KZ_RAMP_SMOOTH = 1 } kz_ramp_shape;
struct kz_ramp_plan {
  double from, periods; /* in the units of the key; drive periods */
  int32_t key, shape;   /* kz_ramp_key, kz_ramp_shape */
};

struct kz_alike_plan {
  int64_t phases; /* phases of release for the measure phases */
};
