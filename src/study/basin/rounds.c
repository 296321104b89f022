/* Rounds of discovery and labelling: cells that ended nowhere known feed another one. */
#include <math.h>
#include <stdlib.h>

#include "numerics/step_check.h"
#include "label.h"
#include "window/window.h"

enum {
  ROUNDS = 4,
  RELEASED = 1024 /* starts at a time */
};

/* The states of n cells where labels begin to follow them. */
static kz_status states_of(const kz_window_labels *l, int64_t n, const int64_t *cell, double *state) {
  kz_start start[RELEASED];
  for (int64_t done = 0; done < n; done += RELEASED) {
    const int64_t part = n - done < RELEASED ? n - done : RELEASED;
    for (int64_t i = 0; i < part; i++)
      KZ_TRY(l->labeller.start(l->labeller.context, cell[done + i], KZ_LEVEL_DOUBLE, start + i));
    kz_released_states(l->dynamics, part, start, state + 2 * done);
  }
  return KZ_OK;
}

/* Finds and counts the attractors that the starts of the window, or later the `again` evenly chosen unsettled cells, end on. */
static kz_status rounds_discover(kz_window_labels *l, bool again) {
  const kz_basin_plan *plan = l->plan;
  const int64_t all = again ? l->before[l->tiles.own] : 0, n = again && all < plan->starts ? all : plan->starts;
  KZ_FREED double *state = kz_malloc((size_t)n * 2 * sizeof *state);
  KZ_FREED int32_t *label = kz_malloc((size_t)n * sizeof *label);
  KZ_FREED int64_t *cell = kz_malloc((size_t)n * sizeof *cell);
  kz_status status = again ? kz_pending_pick(l, 0, all, n, cell) : KZ_OK;
  if (again && status == KZ_OK) status = states_of(l, n, cell, state);
  if (status == KZ_OK)
    status = again ? kz_discover(l->run, l->dynamics, plan->max_periods, n, state, label)
                   : kz_search_window(l->run, l->dynamics, &l->search, label);
  if (status == KZ_OK && kz_dynamics_count(l->dynamics) > INT16_MAX)
    status = kz_fail(KZ_FAILED, "basin: more than %d attractors", INT16_MAX);
  for (int64_t i = 0; status == KZ_OK && i < n; i++) l->reached[label[i]]++;
  return status;
}

static kz_status label_tile(void *context, int64_t tile, void *record) {
  kz_window_labels *l = context;
  const int64_t first = kz_tile_first(&l->tiles, tile), n = kz_tile_own(&l->tiles, tile);
  KZ_FREED int64_t *cell = kz_malloc((size_t)n * sizeof *cell);
  for (int64_t i = 0; i < n; i++) cell[i] = first + i;
  const kz_status status = kz_label_cells(l, n, cell, l->cell);
  return status == KZ_OK ? kz_tile_labels_pack(l, tile, record) : status;
}

static kz_status label_tiles(kz_window_labels *l) {
  kz_stage stage = {.name = "cells 1",
                    .n_tiles = l->tiles.own,
                    .record_bytes = kz_tile_labels_bytes(l),
                    .work = label_tile,
                    .context = l,
                    .keep = true,
                    .local = &l->records};
  return kz_stage_run(l->run, &stage, NULL);
}

/* The starts of all cells, after the images of the window where they need them; the check of a map table that labels them. Nothing is checked
 * if basin.accuracy chose the setting, which compares labels. */
static kz_status make_starts(kz_window_labels *l) {
  const kz_basin_plan *plan = l->plan;
  if (kz_plan_is_centred(plan) && plan->method == KZ_METHOD_EXACT) {
    l->images = kz_images_create(l->pendulum, &plan->theta, &plan->velocity);
    KZ_TRY(kz_images_run(l->run, l->dynamics, l->images, plan->max_periods));
  }
  kz_window_labels_start(l);
  if (plan->method != KZ_METHOD_ICM || !isnan(plan->accuracy)) return KZ_OK;
  return kz_ranks_agree(l->run->ranks,
                        kz_steps_check_table(plan, kz_dynamics_table_error(l->dynamics, kz_stencil(plan->interpolation))));
}

/* `exact` alone leaves doubtful cells. */
static kz_status run_rounds(kz_window_labels *l) {
  KZ_TRY(rounds_discover(l, false));
  KZ_TRY(make_starts(l));
  KZ_TRY(label_tiles(l));
  KZ_TRY(kz_pending_count(l, KZ_DOUBTFUL));
  KZ_TRY(kz_pending_label(l, KZ_LEVEL_FINE, 1));
  for (int round = 1; round < ROUNDS; round++) {
    KZ_TRY(kz_pending_count(l, 0));
    if (l->before[l->tiles.own] == 0) return KZ_OK;
    const int64_t known = kz_dynamics_count(l->dynamics);
    KZ_TRY(rounds_discover(l, true));
    if (kz_dynamics_count(l->dynamics) == known) return KZ_OK;
    KZ_TRY(kz_pending_label(l, KZ_LEVEL_DOUBLE, round + 1));
  }
  return KZ_OK;
}

/* The starts' counts of attractors are the same on every rank, those of tiles each rank's own. */
kz_status kz_label_window(kz_window_labels *l) {
  l->cell = kz_calloc((size_t)kz_tile_capacity(&l->tiles) + 1, sizeof *l->cell);
  l->before = kz_calloc((size_t)l->tiles.own + 1, sizeof *l->before);
  l->reached = kz_calloc(INT16_MAX + 1, sizeof *l->reached);
  KZ_TRY(run_rounds(l));
  for (int i = 0; i <= INT16_MAX && kz_rank(l->run->ranks) != 0; i++) l->reached[i] = 0;
  for (int64_t i = 0; i < l->records.n; i++) kz_tile_labels_note_reached(l, &l->records.list[i]);
  return kz_ranks_sum(l->run->ranks, l->reached, INT16_MAX + 1);
}

void kz_window_labels_free(kz_window_labels *l) {
  kz_local_records_free(&l->records);
  kz_window_starts_free(&l->starts);
  kz_images_free(l->images);
  free(l->cell);
  free(l->before);
  free(l->reached);
}
