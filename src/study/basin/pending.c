/* Pending cells - unsettled, or doubtful -: counted, picked and labelled again, a bounded number at a time, level by level. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "label_parts.h"

enum { MOST_PENDING = 1 << 20 }; /* cells that a rank lists at a time; more than a tile has */

static int64_t tile_size(const kz_window_labels *l) {
  const int64_t most = kz_level_tile(l->level);
  return l->batch < most ? l->batch : most;
}

kz_status kz_pending_count(kz_window_labels *l, int16_t wanted) {
  l->wanted = wanted;
  int64_t *before = memset(l->before, 0, (size_t)(l->tiles.own + 1) * sizeof *before);
  for (int64_t i = 0; i < l->records.n; i++)
    before[l->records.list[i].tile + 1] = kz_tile_labels_pending(&l->records.list[i], wanted);
  KZ_TRY(kz_ranks_sum(l->run->ranks, before, l->tiles.own + 1));
  for (int64_t tile = 0; tile < l->tiles.own; tile++) before[tile + 1] += before[tile];
  return KZ_OK;
}

/* Those of the wanted cells that lie in one tile. */
static kz_status pick_from(kz_window_labels *l, const kz_local_record *packed, int64_t from, int64_t of, int64_t n,
                           int64_t *cell) {
  int64_t number = l->before[packed->tile], i = number > from ? ((number - from) * n + of - 1) / of : 0;
  const int64_t end = l->before[packed->tile + 1], first = kz_tile_first(&l->tiles, packed->tile);
  if (i >= n || from + i * of / n >= end || end == number) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; i < n && number < end; k++) {
    if (l->cell[k].label != l->wanted) continue;
    if (from + i * of / n == number) cell[i++] = first + k;
    number++;
  }
  return KZ_OK;
}

kz_status kz_pending_pick(kz_window_labels *l, int64_t from, int64_t of, int64_t n, int64_t *cell) {
  kz_status status = KZ_OK;
  memset(cell, 0, (size_t)n * sizeof *cell);
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++) status = pick_from(l, &l->records.list[i], from, of, n, cell);
  KZ_TRY(kz_ranks_agree(l->run->ranks, status));
  return kz_ranks_sum(l->run->ranks, cell, n);
}

static kz_status label_pending(void *context, int64_t tile, void *record) {
  kz_window_labels *l = context;
  const int64_t size = tile_size(l), first = tile * size, left = l->n_pending - first;
  return kz_label_cells(l, 0, l->pending + first, left < size ? left : size, record);
}

/* The cells that a level is asked about, and their places among those that are labelled together. */
typedef struct {
  int64_t n, *cell, *place;
} asked;

/* Labels cells at one level: the labels go to `found`, and the cells that the level leaves doubtful stay. */
static kz_status ask_level(kz_window_labels *l, int round, asked *a, kz_cell_label *found) {
  const int64_t size = tile_size(l);
  char name[32];
  snprintf(name, sizeof name, "%s %d", kz_level_name(l->level), round);
  l->pending = a->cell;
  l->n_pending = a->n;
  const kz_stage stage =
      kz_stage_for_all(name, (a->n + size - 1) / size, (size_t)size * sizeof(kz_cell_label), label_pending, l);
  kz_cell_label *label = kz_malloc((size_t)stage.n_tiles * stage.record_bytes + 1);
  const kz_status status = kz_stage_run(l->run, &stage, label);
  int64_t left = 0;
  for (int64_t i = 0; i < a->n && status == KZ_OK; i++) {
    found[a->place[i]] = label[i];
    if (label[i].label != KZ_DOUBTFUL) continue;
    a->cell[left] = a->cell[i];
    a->place[left++] = a->place[i];
  }
  a->n = left;
  free(label);
  return status;
}

/* Labels n cells, from a level on, until each is decided or no level is left: found [n]. */
static kz_status escalate(kz_window_labels *l, int level, int round, int64_t n, int64_t *cell, kz_cell_label *found) {
  const kz_labeller labeller = kz_cells_labeller(l);
  asked a = {n, cell, kz_malloc((size_t)n * sizeof *a.place + 1)};
  kz_status status = KZ_OK;
  for (int64_t i = 0; i < n; i++) a.place[i] = i;
  l->before_level = KZ_LEVEL_DOUBLE;
  for (l->level = level; a.n > 0 && status == KZ_OK;) {
    status = ask_level(l, round, &a, found);
    if (l->level == KZ_LEVELS) break;
    l->before_level = l->level;
    l->level = kz_level_after(&labeller, l->level, a.n);
  }
  l->level = l->before_level = KZ_LEVEL_DOUBLE;
  l->pending = NULL;
  free(a.place);
  return status;
}

/* The new labels of the listed cells, of which the first is pending cell `from`, replace those of a tile of this rank. */
static kz_status merge(kz_window_labels *l, kz_local_record *packed, int64_t from, int64_t n, const kz_cell_label *found,
                       void *record) {
  int64_t number = l->before[packed->tile] - from;
  const int64_t end = l->before[packed->tile + 1] - from;
  if (number < 0 || number == end || end > n) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; number < end; k++)
    if (l->cell[k].label == l->wanted) l->cell[k] = found[number++];
  return kz_tile_labels_replace(l, packed, record);
}

/* The n pending cells from `from` on, which are those of whole tiles. */
static kz_status label_tiles(kz_window_labels *l, int level, int round, int64_t from, int64_t n, int64_t *cell) {
  KZ_TRY(kz_pending_pick(l, from, n, n, cell));
  kz_cell_label *found = kz_malloc((size_t)n * sizeof *found);
  void *record = kz_malloc(kz_tile_labels_bytes(l));
  kz_status status = escalate(l, level, round, n, cell, found);
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++) status = merge(l, &l->records.list[i], from, n, found, record);
  free(found);
  free(record);
  return kz_ranks_agree(l->run->ranks, status);
}

kz_status kz_pending_label(kz_window_labels *l, int level, int round) {
  const int64_t *before = l->before, all = before[l->tiles.own];
  const int64_t most = all < MOST_PENDING ? all : MOST_PENDING;
  int64_t *cell = kz_malloc((size_t)most * sizeof *cell + 1);
  kz_status status = KZ_OK;
  for (int64_t from = 0, to; from < l->tiles.own && status == KZ_OK; from = to) {
    for (to = from + 1; to < l->tiles.own && before[to + 1] - before[from] <= most;) to++;
    if (before[to] > before[from]) status = label_tiles(l, level, round, before[from], before[to] - before[from], cell);
  }
  free(cell);
  return status;
}
