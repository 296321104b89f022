#include "cell_starts.h"

#include "numerics/cells.h"

static double *cell_starts_centres(const kz_axis *axis) {
  double *centre = kz_malloc((size_t)axis->count * sizeof *centre);
  for (int64_t cell = 0; cell < axis->count; cell++) centre[cell] = kz_axis_centre(axis, cell);
  return centre;
}

void kz_cell_starts_make(const kz_basin_plan *plan, kz_cell_starts *starts) {
  *starts = (kz_cell_starts){plan, {cell_starts_centres(&plan->theta), cell_starts_centres(&plan->velocity)}};
}

void kz_cell_starts_free(kz_cell_starts *starts) {
  free(starts->centre[0]);
  free(starts->centre[1]);
  *starts = (kz_cell_starts){0};
}

kz_status kz_cell_starts_at(void *starts, int64_t cell, kz_precision level, kz_start *start) {
  const kz_cell_starts *s = starts;
  (void)level;
  *start = (kz_start){0}; /* in place: a copy of what was just written waits for it */
  start->theta[0] = s->centre[0][cell % s->plan->theta.count];
  start->velocity[0] = s->centre[1][cell / s->plan->theta.count];
  return KZ_OK;
}

kz_labeller kz_cell_starts_labeller(const kz_cell_starts *starts, kz_dynamics *dynamics) {
  return (kz_labeller){dynamics,           starts->plan->max_periods,  KZ_BY_LEVELS,
                       KZ_OPEN_CANDIDATES, .start = kz_cell_starts_at, .context = (void *)starts};
}

/* A kz_start_fn: the items are cells of a plan. */
static kz_status start_of_cell(void *context, int64_t item, kz_precision level, kz_start *start) {
  double centre[2];
  (void)level;
  kz_cell_start(context, item, centre);
  *start = kz_start_at(centre[0], centre[1]);
  return KZ_OK;
}

kz_labeller kz_cell_labeller(const kz_basin_plan *plan, kz_dynamics *dynamics) {
  return (kz_labeller){dynamics, plan->max_periods, KZ_BY_LEVELS, .start = start_of_cell, .context = (void *)plan};
}

kz_way kz_way_of(kz_method method) {
  if (method == KZ_METHOD_ICM) return KZ_BY_STATES;
  return method == KZ_METHOD_EXACT ? KZ_BY_LEVELS : KZ_BY_MARKS;
}

kz_stepper kz_stepper_of(kz_method method, kz_interpolation interpolation) {
  if (method != KZ_METHOD_ICM) return KZ_FOLLOW_DIRECT;
  return interpolation == KZ_LINEAR ? KZ_FOLLOW_LINEAR : KZ_FOLLOW_QUINTIC;
}
