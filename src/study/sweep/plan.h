/* What a scene says of the study `sweep`. */
#ifndef KAPITZA_STUDY_SWEEP_PLAN_H
#define KAPITZA_STUDY_SWEEP_PLAN_H

#include "kapitza/study.h"

struct kz_sweep_plan {
  int32_t parameter;       /* row of kz_sweep_parameters */
  kz_axis values;          /* both ends included */
  kz_integers measure;     /* indices in the list of kz_sweep_measure_words() */
  kz_axis theta, velocity; /* window of starts; the counts of the axes are not used */
  int64_t starts, max_period, seed;
  double start_theta, start_velocity; /* of the bifurcation diagram */
  int64_t transient, samples;         /* drive periods at each value: before the record, and recorded */
  double shock_scale;                 /* for resilience: see kz_shocks_plan */
  int64_t phases;                     /* number of phases of release, for the measure phases */
};

#endif
