/* Pending cells - unsettled, or doubtful -: counted, picked and labelled again, a bounded number at a time, by the levels of method exact. */
#include <stdio.h>
#include <string.h>

#include "label.h"

enum { MOST_PENDING = 1 << 20 }; /* cells that a rank lists at a time; more than a tile has */

const kz_level_stage kz_level_stages[KZ_LEVELS + 1] = {
    [KZ_LEVEL_DOUBLE] = {"cells", 4096, KZ_FOLLOWED},      [KZ_LEVEL_FINE] = {"fine", 4096, KZ_IN_FINE},
    [KZ_LEVEL_PAIRS_16] = {"pairs 16", 4096, KZ_IN_PAIRS}, [KZ_LEVEL_PAIRS_20] = {"pairs 20", 2048, KZ_IN_PAIRS},
    [KZ_LEVEL_PAIRS_24] = {"pairs 24", 2048, KZ_IN_PAIRS}, [KZ_LEVEL_PAIRS_28] = {"pairs 28", 1024, KZ_IN_PAIRS},
    [KZ_LEVEL_QUAD] = {"quad", 256, KZ_IN_QUAD},           [KZ_LEVEL_ARBITRARY] = {"arbitrary", 1, KZ_IN_ARBITRARY},
    [KZ_LEVELS] = {"candidates", 64, KZ_UNDECIDED},
};

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

/* Cells that a level is asked about, in a stage. */
typedef struct {
  const kz_window_labels *labels;
  int32_t level, before; /* the level; that at which they were doubtful */
  int64_t tile;          /* cells of a tile */
  int64_t n, *cell;      /* [n] */
} asked;

/* The first level by the method's own numerics; KZ_LEVELS: the candidates of what no level decides. */
static kz_status ask_tile(void *context, int64_t tile, void *record) {
  const asked *a = context;
  const kz_labeller *labeller = &a->labels->labeller;
  const int64_t first = tile * a->tile, n = a->n - first < a->tile ? a->n - first : a->tile, *cell = a->cell + first;
  kz_cell_label *out = record;
  if (a->level == KZ_LEVEL_DOUBLE) return kz_label_cells(a->labels, n, cell, out);
  KZ_TRY(kz_ranks_interrupted(a->labels->run->ranks));
  KZ_FREED kz_decision *decision = kz_malloc((size_t)n * sizeof *decision);
  KZ_TRY(a->level == KZ_LEVELS ? kz_label_candidates(labeller, n, cell, decision)
                               : kz_label_at(labeller, a->level, a->before, n, cell, decision));
  for (int64_t i = 0; i < n; i++) out[i] = kz_cell_label_of(decision + i, kz_level_stages[a->level].evidence);
  return KZ_OK;
}

/* Labels the cells at one level: found [place] of each. The cells that the level leaves doubtful, and their places, move to the front. */
static kz_status ask_level(asked *a, int round, int64_t *place, kz_cell_label *found) {
  const kz_level_stage *row = &kz_level_stages[a->level];
  char name[32];
  snprintf(name, sizeof name, "%s %d", row->name, round);
  a->tile = a->labels->batch < row->tile ? a->labels->batch : row->tile;
  const kz_stage stage =
      kz_stage_for_all(name, (a->n + a->tile - 1) / a->tile, (size_t)a->tile * sizeof(kz_cell_label), ask_tile, a);
  KZ_FREED kz_cell_label *label = kz_malloc((size_t)stage.n_tiles * stage.record_bytes + 1);
  KZ_TRY(kz_stage_run(a->labels->run, &stage, label));
  int64_t left = 0;
  for (int64_t i = 0; i < a->n; i++) {
    found[place[i]] = label[i];
    if (label[i].label != KZ_DOUBTFUL) continue;
    a->cell[left] = a->cell[i];
    place[left++] = place[i];
  }
  a->n = left;
  return KZ_OK;
}

/* Labels n cells, from a level on, until each is decided or no level is left: found [n]. */
static kz_status escalate(const kz_window_labels *l, int level, int round, int64_t n, int64_t *cell, kz_cell_label *found) {
  asked a = {.labels = l, .level = level, .before = KZ_LEVEL_DOUBLE, .n = n, .cell = cell};
  KZ_FREED int64_t *place = kz_malloc((size_t)n * sizeof *place + 1);
  kz_status status = KZ_OK;
  for (int64_t i = 0; i < n; i++) place[i] = i;
  while (a.n > 0 && status == KZ_OK) {
    status = ask_level(&a, round, place, found);
    if (a.level == KZ_LEVELS) break;
    a.before = a.level;
    a.level = kz_level_after(&l->labeller, a.level, a.n);
  }
  return status;
}

/* The new labels of the listed cells, of which the first is pending cell `from`, replace those of a tile of this rank. */
static kz_status merge(kz_window_labels *l, kz_local_record *packed, int64_t from, int64_t n, const kz_cell_label *found) {
  int64_t number = l->before[packed->tile] - from;
  const int64_t end = l->before[packed->tile + 1] - from;
  if (number < 0 || number == end || end > n) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; number < end; k++)
    if (l->cell[k].label == l->wanted) l->cell[k] = found[number++];
  return kz_tile_labels_replace(l, packed);
}

/* The n pending cells from `from` on, which are those of whole tiles. */
static kz_status label_tiles(kz_window_labels *l, int level, int round, int64_t from, int64_t n, int64_t *cell) {
  KZ_TRY(kz_pending_pick(l, from, n, n, cell));
  KZ_FREED kz_cell_label *found = kz_malloc((size_t)n * sizeof *found);
  kz_status status = escalate(l, level, round, n, cell, found);
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++) status = merge(l, &l->records.list[i], from, n, found);
  return kz_ranks_agree(l->run->ranks, status);
}

kz_status kz_pending_label(kz_window_labels *l, int level, int round) {
  const int64_t *before = l->before, all = before[l->tiles.own];
  const int64_t most = all < MOST_PENDING ? all : MOST_PENDING;
  KZ_FREED int64_t *cell = kz_malloc((size_t)most * sizeof *cell + 1);
  kz_status status = KZ_OK;
  for (int64_t from = 0, to; from < l->tiles.own && status == KZ_OK; from = to) {
    for (to = from + 1; to < l->tiles.own && before[to + 1] - before[from] <= most;) to++;
    if (before[to] > before[from]) status = label_tiles(l, level, round, before[from], before[to] - before[from], cell);
  }
  return status;
}
