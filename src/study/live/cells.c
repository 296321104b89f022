#include "cells.h"

#include <stdlib.h>

#include "labelling/labeller.h"
#include "numerics/cells.h"

/* As method direct labels them. */
static void follow(const kz_resident *r, const kz_basin_plan *plan, int64_t n, const int64_t *number, kz_frame_cell *cells) {
  double state[2 * KZ_FRAME_TILE];
  int32_t label[KZ_FRAME_TILE];
  int64_t periods[KZ_FRAME_TILE];
  for (int64_t i = 0; i < n; i++) kz_cell_state(plan, number[i], state + 2 * i);
  kz_dynamics_follow(r->dynamics, KZ_FOLLOW_DIRECT, n, plan->max_periods, state, label, periods);
  for (int64_t i = 0; i < n; i++)
    cells[number[i]] = (kz_frame_cell){.label = (int16_t)label[i], .periods = (float)periods[i], .state = KZ_CELL_FOLLOWED};
}

/* A kz_start_fn: the centre of a cell. */
static kz_status start_cell(void *context, int64_t cell, int32_t level, kz_start *start) {
  const kz_basin_plan *plan = context;
  (void)level;
  *start = (kz_start){.periods = 0};
  kz_axis_pair(&plan->theta, cell % plan->theta.count, start->theta);
  kz_axis_pair(&plan->velocity, cell / plan->theta.count, start->velocity);
  return KZ_OK;
}

/* As method exact labels them. */
static kz_status decide(const kz_resident *r, const kz_basin_plan *plan, int64_t n, const int64_t *number,
                        kz_frame_cell *cells) {
  kz_decision decision[KZ_FRAME_TILE];
  const kz_labeller labeller = {
      .dynamics = r->dynamics, .max_periods = plan->max_periods, .start = start_cell, .context = (void *)plan};
  KZ_TRY(kz_label(&labeller, n, number, decision));
  for (int64_t i = 0; i < n; i++) {
    kz_decision *d = decision + i;
    const bool open = d->label == KZ_DOUBTFUL;
    if (open) KZ_TRY(kz_label_candidates(&labeller, 1, number + i, d));
    cells[number[i]] = (kz_frame_cell){.label = (int16_t)d->label,
                                       .other = (int16_t)(open ? d->other : 0),
                                       .periods = (float)d->periods,
                                       .state = open ? KZ_CELL_UNDECIDED : KZ_CELL_DECIDED};
  }
  return KZ_OK;
}

kz_status kz_cells_follow(const kz_resident *resident, const kz_basin_plan *plan, int64_t n, const int64_t *number,
                          kz_frame_cell *cells) {
  const bool deep = kz_axis_is_deep(&plan->theta) || kz_axis_is_deep(&plan->velocity);
  if (!resident->moving || deep) return decide(resident, plan, n, number, cells);
  follow(resident, plan, n, number, cells);
  return KZ_OK;
}

kz_status kz_cells_discover(kz_resident *resident, const kz_basin_plan *plan, int64_t n, const int64_t *number, bool *born) {
  enum { MOST = 64 };
  double state[2 * MOST];
  int32_t label[MOST];
  const int64_t known = kz_dynamics_count(resident->dynamics), share = (n + MOST - 1) / MOST;
  int64_t taken = 0;
  for (int64_t i = 0; i < n; i += share) kz_cell_state(plan, number[i], state + 2 * taken++);
  KZ_TRY(kz_discover(NULL, resident->dynamics, plan->max_periods, taken, state, label));
  *born = kz_dynamics_count(resident->dynamics) > known;
  if (*born) kz_dynamics_update(resident->dynamics);
  return KZ_OK;
}
