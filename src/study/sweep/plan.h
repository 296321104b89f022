/* What a scene says of the study `sweep`. */
#pragma once

#include "kapitza/study.h"
#include "../measures/plan.h"

/* The measures of a sweep: code, word in the scene, the function that runs it. The first five come from the branches and have no functions of
 * their own; ends is over a plane, all others along one key. Further words are those of the table of measures (src/study/measures). */
#define KZ_SWEEP_MEASURES(MEASURE)                                   \
  MEASURE(KZ_SWEEP_ATTRACTORS, "attractors", NULL)                   \
  MEASURE(KZ_SWEEP_BASIN_FRACTIONS, "basin_fractions", NULL)         \
  MEASURE(KZ_SWEEP_LIFETIME, "lifetime", NULL)                       \
  MEASURE(KZ_SWEEP_RESILIENCE, "resilience", NULL)                   \
  MEASURE(KZ_SWEEP_PHASES, "phases", NULL)                           \
  MEASURE(KZ_SWEEP_RELEASE_ANGLE, "release_angle", kz_sweep_release) \
  MEASURE(KZ_SWEEP_STROBE, "strobe", kz_sweep_strobe)                \
  MEASURE(KZ_SWEEP_ENDS, "ends", kz_ends_run)
#define KZ_MEASURE_CODE(code, word, run) code,
enum { KZ_SWEEP_MEASURES(KZ_MEASURE_CODE) KZ_SWEEP_TABLE /* from here on the rows of kz_measures */ };

/* The measure ends: starts that are the same at every point of a plane. */
enum { KZ_ENDS_MOST_PERIOD = 64 };
typedef struct {
  kz_reals theta, velocity;        /* rad, rad per drive radian; a single velocity belongs to all angles */
  int64_t max_period, max_periods; /* max_periods INT64_MIN = not given */
} kz_ends_plan;

struct kz_sweep_plan {
  int32_t parameter;       /* row of kz_sweep_parameters; KZ_UNSET_WORD = over a plane */
  kz_axis range;           /* as the scene gives it, or `listed`; NaN = not given */
  kz_reals listed;         /* ascending */
  kz_axis values;          /* the range, or the ends and the number of the list: kz_sweep_value has each */
  kz_plane_axis x, y;      /* of a plane */
  kz_integers measure;     /* indices in the list of kz_sweep_measure_words() */
  kz_axis theta, velocity; /* window of starts; the counts of the axes are not used */
  int64_t starts, max_period, seed;
  double start_theta, start_velocity; /* of the bifurcation diagram */
  int64_t transient, samples;         /* drive periods at each value: before the record, and recorded */
  kz_measure_options options;         /* for resilience too: see kz_shocks_plan */
  kz_ends_plan ends;
  int64_t phases; /* number of phases of release, for the measure phases */
};

/* The rows of kz_measures that the sweep names; whether there are any. */
kz_integers kz_sweep_table_names(const kz_sweep_plan *plan);
static inline bool kz_sweep_has_table(const kz_sweep_plan *plan) {
  bool has = false;
  for (int64_t i = 0; i < plan->measure.count; i++) has = has || plan->measure.values[i] >= KZ_SWEEP_TABLE;
  return has;
}
/* NULL, or what is wrong with the measures of a sweep, as "KEY: what is wrong" where KEY is a key of it. */
const char *kz_sweep_lack(const kz_scene *scene);

static inline bool kz_sweep_is_plane(const kz_sweep_plan *plan) {
  return plan->x.parameter >= 0 && plan->parameter < 0;
}
