/* Study `stability`: the chart of the (damped) Mathieu equation over (k, m), and transition curves over k. */
#ifndef KAPITZA_STUDY_STABILITY_H
#define KAPITZA_STUDY_STABILITY_H

#include "kapitza/analysis.h"
#include "kapitza/study.h"

/* ---- inside the study ---- */

/* A curve to follow: a row of kz_curves, or (row < 0) the two curves of a subharmonic order. */
typedef struct {
  int32_t row, order;
} kz_curve_task;

typedef struct {
  const kz_stability_plan *plan;
  kz_damping damping;
  double *k, *m; /* the axes */
  kz_curve_task *tasks;
  int64_t n_tasks;
  double *log_multiplier, *angle; /* [m][k]; this and the following on rank 0 only */
  uint8_t *stable;
  double *curves; /* [task][2][k]: the curve; for a subharmonic order the exact curve and the formula */
} kz_chart;

/* Writes the variables and attributes of the groups, and prints the summary. Rank 0. */
kz_status kz_chart_write(const kz_chart *chart, kz_store *store);
void kz_chart_summarise(const kz_chart *chart, FILE *summary);

#endif
