/* Study `stability`: chart of the (damped) Hill or Mathieu equation over (k, m), transition curves over k or m. */
#pragma once

#include "kapitza/study_stability.h"

/* Whether a chart asks for a curve whose name begins so, and for one that only a sine has. */
bool kz_stability_has_curve(const kz_stability_plan *plan, const char *stability_begin);
bool kz_stability_needs_sine(const kz_stability_plan *plan);

/* The axes of a chart in k and m, however the scene gives them. */
typedef struct {
  kz_axis k, m;
} kz_chart_axes;
kz_chart_axes kz_stability_axes(const kz_stability_plan *plan);

/* ---- inside the study ---- */

/* A curve to follow: a row of kz_curves, or (row < 0) the two curves of a subharmonic order. */
typedef struct {
  int32_t row, order;
} kz_curve_task;

/* A point of the chart; of a curve: m, or k over m, and for a subharmonic order the exact curve and the formula. */
typedef struct {
  double log_multiplier, angle;
  uint8_t stable;
} kz_chart_point;
typedef struct {
  double value[2];
} kz_curve_point;

typedef struct {
  const kz_stability_plan *plan;
  kz_chart_axes axes;
  kz_pendulum form; /* the drive, for k = 0 and m = 1 */
  kz_damping damping;
  double *k, *m; /* values of the axes */
  kz_curve_task *tasks;
  int64_t n_tasks;
  kz_chart_point *points; /* [m][k]; this and the curves on rank 0 only */
  kz_curve_point *curves; /* [task][stride] */
  int64_t stride;         /* the longer axis or a little more */
} kz_chart;

/* Values of a row of the chart's curves: the larger number of k and m. */
static inline int64_t kz_chart_row(const kz_chart_axes *axes) {
  return axes->k.count > axes->m.count ? axes->k.count : axes->m.count;
}

/* Writes the variables and attributes of the groups, and prints the summary. Rank 0. */
kz_status kz_chart_write(const kz_chart *chart, kz_store *store);
void kz_chart_summarise(const kz_chart *chart, FILE *summary);
