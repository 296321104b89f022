/* Plan of the study `measures`, and of measures of its table in a sweep. */
#pragma once

#include "kapitza/study.h"

/* Parameters of single measures, with equal keys in `measures` and in `sweep`. */
typedef struct {
  bool has_weight; /* for weighted_share: a Gaussian distribution of starts */
  struct {
    double theta, velocity, theta_spread, velocity_spread; /* mean and standard deviation: rad, rad per drive radian */
  } weight;
  int64_t within;         /* drive periods, for share_within; KZ_UNSET_INTEGER = not given */
  kz_reals sizes;         /* Sizes of shocks for `harmless`, rad */
  int64_t cells;          /* Cells of the picture along each axis */
  double shock_scale;     /* velocity, rad per drive radian, that counts as much as 1 rad */
  double shock_tolerance; /* Relative tolerance of smallest shocks; 0 = as close as can be */
} kz_measure_options;

/* How the study labels its starts: each label decided, or by doubles alone. */
enum { KZ_MEASURES_EXACT, KZ_MEASURES_DIRECT };

struct kz_measures_plan {
  kz_integers names;       /* rows of kz_measures */
  kz_axis theta, velocity; /* window of starts and picture; the counts of the axes are not used */
  int64_t starts, max_period, seed;
  int32_t method; /* KZ_MEASURES_EXACT or KZ_MEASURES_DIRECT */
  kz_measure_options options;
};

/* Returns the missing option of these measures as "KEY: what is wrong" (kz_measure_options), NULL = none. */
const char *kz_measures_lack(const kz_integers *rows_names, const kz_measure_options *options);

/* In a sweep; window, starts and words are those of the sweep. */
struct kz_swept_plan {
  kz_measure_options options;
};
