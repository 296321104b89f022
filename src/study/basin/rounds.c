/* The attractors of a window, then the labels of its cells, tile by tile. */
#include <math.h>
#include <stdlib.h>

#include "numerics/step_check.h"
#include "label.h"
#include "window/window.h"
#include "plan.h"

enum { ROUNDS = 3 /* of search among cells that end nowhere known, at most */ };

/* Finds and counts the attractors that the starts of the window end on. */
static kz_status find_attractors(kz_window_labels *l) {
  KZ_FREED int32_t *label = kz_malloc((size_t)l->plan->starts * sizeof *label);
  KZ_TRY(kz_search_window(l->run, l->dynamics, &l->search, label));
  for (int64_t i = 0; i < l->plan->starts; i++) l->reached[label[i]]++;
  return KZ_OK;
}

static kz_status label_tile(void *context, int64_t tile, void *record) {
  kz_window_labels *l = context;
  const int64_t first = kz_tile_first(&l->tiles, tile), n = kz_tile_own(&l->tiles, tile);
  KZ_FREED int64_t *cell = kz_malloc((size_t)n * sizeof *cell);
  for (int64_t i = 0; i < n; i++) cell[i] = first + i;
  const kz_status status = kz_label_first(&l->labeller, n, cell, l->cell);
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
    l->images = kz_images_create(l->parameters, &plan->theta, &plan->velocity);
    KZ_TRY(kz_images_run(l->run, l->dynamics, l->images, plan->max_periods));
  }
  kz_window_labels_start(l);
  if (plan->method != KZ_METHOD_ICM || !isnan(plan->accuracy)) return KZ_OK;
  return kz_ranks_agree(l->run->ranks,
                        kz_steps_check_table(plan, kz_dynamics_table_error(l->dynamics, kz_stencil(plan->interpolation))));
}

static kz_status count_unsettled(void *labels, int64_t *n) {
  kz_window_labels *l = labels;
  KZ_TRY(kz_pending_count(l, 0));
  *n = l->before[l->tiles.own];
  return KZ_OK;
}

static kz_status pick(void *labels, int64_t all, int64_t n, int64_t *cell) {
  return kz_pending_pick(labels, 0, all, n, cell, NULL);
}

static kz_status label_again(void *labels, int round) {
  return kz_pending_label(labels, round);
}

/* `exact` alone leaves doubtful cells. */
static kz_status label_all(kz_window_labels *l) {
  const kz_unsettled unsettled = {count_unsettled, pick, label_again, l};
  const kz_search_on search = {ROUNDS, l->plan->starts, l->reached};
  KZ_TRY(find_attractors(l));
  KZ_TRY(make_starts(l));
  KZ_TRY(label_tiles(l));
  KZ_TRY(kz_pending_count(l, KZ_DOUBTFUL));
  KZ_TRY(kz_pending_label(l, 1));
  return kz_search_rounds(&l->labeller, &search, &unsettled);
}

/* The starts' counts of attractors are the same on every rank, those of tiles each rank's own. */
kz_status kz_label_window(kz_window_labels *l) {
  l->cell = kz_calloc((size_t)kz_tile_capacity(&l->tiles) + 1, sizeof *l->cell);
  l->before = kz_calloc((size_t)l->tiles.own + 1, sizeof *l->before);
  l->reached = kz_calloc(INT16_MAX + 1, sizeof *l->reached);
  KZ_TRY(label_all(l));
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
