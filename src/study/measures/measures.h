/* Study `measures`: numbers about the attractors of a pendulum and their basins. */
#pragma once

#include "resilience/resilience.h"
#include "plan.h"
#include "table.h"

/* Starts [n][2] (rad, rad per drive radian), id [n] in the catalogue, -1 = none, time [n] in drive periods. */
typedef struct {
  int64_t n;
  const double *start;
  const int16_t *id;
  const uint32_t *time;
} kz_ended;

/* The derivative of the map of one drive period, row-major, at a strobe point. */
typedef struct {
  double matrix[4];
} kz_tangent;

/* Measured properties of a pendulum; unneeded parts are empty. The picture has cells x cells labels, velocity-major. */
typedef struct {
  const kz_measures_plan *plan;
  kz_catalogue catalogue;
  kz_ended starts, weighted, picture;
  kz_tangent *tangent; /* tangents at all strobe points of all cycles, attractor by attractor; NULL = not needed */
  int64_t n_points;
  kz_resilience *point; /* [n_points] shocks at them */
  kz_dynamics *dynamics;
  double *start; /* buffers of the three sets */
  int16_t *id;
  uint32_t *time;
} kz_measured;

/* Fills value: [attractors]; with an interval [3][attractors] (number, low, high); [attractors][sizes];
 * [attractors][attractors]; [1]. NaN where the measure is not defined. */
typedef void (*kz_measure_fn)(const kz_measured *measured, double *value);
typedef struct {
  const char *word;
  const char *unit; /* as the variables of the file have it; behind "1|" one of the drive */
  kz_measure_shape shape;
  int32_t needs;
  kz_measure_fn fill;
} kz_measure;
extern const kz_measure kz_measures[];
/* The words, joined by '|'. */
const char *kz_measure_words(void);
/* Number of values that a measure fills. */
int64_t kz_measure_length(const kz_measure *measure, const kz_measured *measured);

/* Needs of all measures of a plan together. */
int32_t kz_measures_need(const kz_integers *rows_names);
/* Looks for the attractors and computes what is needed, in the way KZ_BY_LEVELS or KZ_BY_STATES. The plan must outlive
 * it; freed by kz_measured_free in every case. Collective. */
kz_status kz_measured_make(const kz_pendulum *pendulum, const kz_numerics *numerics, const kz_measures_plan *plan,
                           kz_way way, int32_t needs, const kz_run *run, kz_measured *measured);
void kz_measured_free(kz_measured *measured);

#define KZ_MEASURE_DECLARED(word, ...) void kz_measure_##word(const kz_measured *measured, double *value);
KZ_MEASURES(KZ_MEASURE_DECLARED, KZ_MEASURE_DECLARED, KZ_MEASURE_DECLARED, KZ_MEASURE_DECLARED, KZ_MEASURE_DECLARED)
