/* The attractors of a window, then the labels of its cells, tile by tile. */
#include "numerics/step_check.h"
#include "label.h"
#include "kapitza/dynamics_steps.h"

/* ---- pending cells, unsettled or doubtful: counted, picked and labelled again, a bounded number at a time ---- */

enum { MOST_PENDING = 1 << 20 }; /* cells that a rank lists at a time; more than a tile has */

/* Counts cells with the label `wanted` in all tiles into labelling->before; they become pending. Collective. */
static kz_status count_pending(kz_window_labels *l, int16_t wanted) {
  l->wanted = wanted;
  int64_t *before = memset(l->before, 0, (size_t)(l->tiles.own + 1) * sizeof *before);
  for (int64_t i = 0; i < l->records.n; i++)
    before[l->records.list[i].tile + 1] = kz_tile_labels_pending(&l->records.list[i], wanted);
  KZ_TRY(kz_ranks_sum(l->run->ranks, before, l->tiles.own + 1));
  for (int64_t tile = 0; tile < l->tiles.own; tile++) before[tile + 1] += before[tile];
  return KZ_OK;
}

/* Wanted cells that lie in one tile. */
static kz_status pick_from(kz_window_labels *l, const kz_local_record *packed, int64_t from, int64_t of, int64_t n,
                           int64_t *cell, int64_t *level) {
  int64_t number = l->before[packed->tile], i = number > from ? ((number - from) * n + of - 1) / of : 0;
  const int64_t end = l->before[packed->tile + 1], first = kz_tile_first(&l->tiles, packed->tile);
  if (i >= n || from + i * of / n >= end || end == number) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; i < n && number < end; k++) {
    if (l->cell[k].label != l->wanted) continue;
    if (from + i * of / n == number) {
      if (level) level[i] = l->cell[k].next;
      cell[i++] = first + k;
    }
    number++;
  }
  return KZ_OK;
}

/* cell [n] = the numbers of n evenly chosen cells among the pending cells from .. from + of - 1, in order, on every
 * rank; level [n] = the levels that may decide them, NULL = not needed. Collective. */
static kz_status pick_pending(kz_window_labels *l, int64_t from, int64_t of, int64_t n, int64_t *cell, int64_t *level) {
  kz_status status = KZ_OK;
  memset(cell, 0, (size_t)n * sizeof *cell);
  if (level) memset(level, 0, (size_t)n * sizeof *level);
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++)
    status = pick_from(l, &l->records.list[i], from, of, n, cell, level);
  KZ_TRY(kz_ranks_agree(l->run->ranks, status));
  if (level) KZ_TRY(kz_ranks_sum(l->run->ranks, level, n));
  return kz_ranks_sum(l->run->ranks, cell, n);
}

/* Puts new labels of listed cells, the first of which is pending cell `from`, into a tile of this rank. */
static kz_status rounds_merge(kz_window_labels *l, kz_local_record *packed, int64_t from, int64_t n,
                              const kz_label *found) {
  int64_t number = l->before[packed->tile] - from;
  const int64_t end = l->before[packed->tile + 1] - from;
  if (number < 0 || number == end || end > n) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; number < end; k++)
    if (l->cell[k].label == l->wanted) l->cell[k] = found[number++];
  return kz_tile_labels_replace(l, packed);
}

/* Labels the pending cells of all tiles, a bounded number at a time: the doubtful ones by the further levels, the
 * unsettled ones from the first one on, in stages of round `round`. Collective. */
static kz_status label_pending(kz_window_labels *l, int round) {
  const int64_t *before = l->before, all = before[l->tiles.own];
  const int64_t most = kz_smaller(all, MOST_PENDING);
  KZ_AUTOFREE int64_t *cell = kz_malloc((size_t)most * sizeof *cell + 1);
  KZ_AUTOFREE int64_t *level = kz_malloc((size_t)most * sizeof *level + 1);
  KZ_AUTOFREE kz_label *found = kz_malloc((size_t)most * sizeof *found + 1);
  for (int64_t from = 0, to; from < l->tiles.own; from = to) {
    for (to = from + 1; to < l->tiles.own && before[to + 1] - before[from] <= most;) to++;
    const int64_t first = before[from], n = before[to] - first; /* pending cells of whole tiles */
    if (n == 0) continue;
    KZ_TRY(pick_pending(l, first, n, n, cell, level));
    for (int64_t i = 0; i < n; i++) found[i] = (kz_label){.label = l->wanted, .next = (uint8_t)level[i]};
    kz_status status = (l->wanted == 0 ? kz_label_items : kz_label_doubtful)(&l->labeller, round, n, cell, found);
    for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++)
      status = rounds_merge(l, &l->records.list[i], first, n, found);
    KZ_TRY(kz_ranks_agree(l->run->ranks, status));
  }
  return KZ_OK;
}

enum { ROUNDS = 3 /* Rounds of search among cells that end nowhere known, at most */ };

/* Finds and counts the attractors that the starts of the window end on. */
static kz_status find_attractors(kz_window_labels *l) {
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)l->plan->starts * sizeof *label);
  KZ_TRY(kz_search_window(l->run, l->dynamics, &l->search, label));
  for (int64_t i = 0; i < l->plan->starts; i++) l->reached[label[i]]++;
  return KZ_OK;
}

/* Labels column by column: neighbouring cells share nodes of the map table, which is larger than the caches. */
static kz_status label_tile(void *context, int64_t tile, void *record) {
  kz_window_labels *l = context;
  const int64_t first = kz_tile_first(&l->tiles, tile), n = kz_tile_own(&l->tiles, tile), columns = l->tiles.chunk[1];
  KZ_AUTOFREE int64_t *cell = kz_malloc((size_t)n * sizeof *cell);
  KZ_AUTOFREE kz_label *found = kz_malloc((size_t)n * sizeof *found);
  for (int64_t column = 0, i = 0; column < columns; column++)
    for (int64_t k = column; k < n; k += columns) cell[i++] = first + k;
  KZ_TRY(kz_label_first(&l->labeller, n, cell, found));
  for (int64_t i = 0; i < n; i++) l->cell[cell[i] - first] = found[i];
  return kz_tile_labels_pack(l, tile, record);
}

static kz_status label_all_tiles(kz_window_labels *l) {
  kz_stage stage = {.name = "cells 1",
                    .n_tiles = l->tiles.own,
                    .record_bytes = kz_tile_labels_bytes(l),
                    .work = label_tile,
                    .context = l,
                    .keep = true,
                    .local = &l->records};
  return kz_stage_run(l->run, &stage, NULL);
}

/* The starts of all cells; the check of a map table that labels them. Nothing is checked
 * if basin.accuracy chose the setting, which compares labels. */
static kz_status make_starts(kz_window_labels *l) {
  const kz_basin_plan *plan = l->plan;
  KZ_TRY(kz_window_labels_start(l));
  if (plan->method != KZ_METHOD_ICM || !isnan(plan->accuracy)) return KZ_OK;
  return kz_ranks_agree(
      l->run->ranks, kz_steps_check_table(plan, kz_dynamics_table_error(l->dynamics, kz_stencil(plan->interpolation))));
}

static kz_status count_unsettled(void *labels, int64_t *n) {
  kz_window_labels *l = labels;
  KZ_TRY(count_pending(l, 0));
  *n = l->before[l->tiles.own];
  return KZ_OK;
}

static kz_status rounds_pick(void *labels, int64_t all, int64_t n, int64_t *cell) {
  return pick_pending(labels, 0, all, n, cell, NULL);
}

static kz_status label_again(void *labels, int round) {
  return label_pending(labels, round);
}

/* Only `exact` leaves doubtful cells. Counts of the starts' attractors are equal on all ranks, tiles' counts not. */
kz_status kz_label_window(kz_window_labels *l) {
  l->cell = kz_calloc((size_t)kz_tile_capacity(&l->tiles) + 1, sizeof *l->cell);
  l->before = kz_calloc((size_t)l->tiles.own + 1, sizeof *l->before);
  l->reached = kz_calloc(INT16_MAX + 1, sizeof *l->reached);
  const kz_unsettled unsettled = {count_unsettled, rounds_pick, label_again, l};
  const kz_search_on search = {ROUNDS, l->plan->starts, l->reached};
  KZ_TRY(find_attractors(l));
  KZ_TRY(make_starts(l));
  KZ_TRY(label_all_tiles(l));
  KZ_TRY(count_pending(l, KZ_DOUBTFUL));
  KZ_TRY(label_pending(l, 1));
  KZ_TRY(kz_search_rounds(&l->labeller, &search, &unsettled));
  for (int i = 0; i <= INT16_MAX && kz_rank(l->run->ranks) != 0; i++) l->reached[i] = 0;
  for (int64_t i = 0; i < l->records.n; i++) kz_tile_labels_note_reached(l, &l->records.list[i]);
  return kz_ranks_sum(l->run->ranks, l->reached, INT16_MAX + 1);
}

void kz_window_labels_free(kz_window_labels *l) {
  kz_local_records_free(&l->records);
  kz_cell_starts_free(&l->starts);
  free(l->cell);
  free(l->before);
  free(l->reached);
}
