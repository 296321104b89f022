/* Labelling one batch of cells, and a whole tile. */
#include "label_parts.h"

#include <stdlib.h>

#include "kapitza/store.h"

enum {
  MOST_DECIDED = 100000
}; /* windows of at most so many cells: own orbits decide their pending cells even if basin.undecided is flag */

/* A packed tile. After it: the numbers of the attractors that it reaches (int32_t), its cells as kz_squeeze has them. */
typedef struct {
  uint64_t bytes; /* all */
  int64_t n_reached, n_pending, n_doubtful;
} head;

struct kz_workspace {
  double state[2 * KZ_BATCH];
  int32_t label[KZ_BATCH];
  int64_t periods[KZ_BATCH], cell[KZ_BATCH];
  kz_decision decision[KZ_BATCH];
};

kz_workspace *kz_workspace_make(void) {
  return kz_malloc(sizeof(kz_workspace));
}

/* By the map table. */
static void follow_batch(const kz_window_labels *l, int64_t n, kz_cell_label *out) {
  const kz_basin_plan *plan = l->plan;
  kz_workspace *w = l->work;
  for (int64_t i = 0; i < n; i++) kz_cell_state(plan, w->cell[i], w->state + 2 * i);
  kz_dynamics_follow(l->dynamics, kz_stepping(plan->method, plan->interpolation), n, plan->max_periods, w->state, w->label,
                     w->periods);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_cell_label){.periods = (uint32_t)w->periods[i], .label = (int16_t)w->label[i], .evidence = KZ_FOLLOWED};
}

kz_labeller kz_cells_labeller(const kz_window_labels *l) {
  return kz_window_labeller(&l->starts,
                            l->plan->undecided == KZ_UNDECIDED_DECIDE || (l->images && l->tiles.cells <= MOST_DECIDED));
}

/* At the present level; by method direct the labels of states alone, and whether their errors change them. */
static kz_status label_batch(kz_window_labels *l, int64_t n, kz_cell_label *out) {
  const kz_labeller labeller = kz_cells_labeller(l);
  kz_decision *decision = l->work->decision;
  const bool direct = l->plan->method == KZ_METHOD_DIRECT;
  if (direct)
    KZ_TRY(kz_label_at(&labeller, KZ_LEVEL_GUESS, KZ_LEVEL_DOUBLE, n, l->work->cell, decision));
  else if (l->level == KZ_LEVELS)
    KZ_TRY(kz_label_candidates(&labeller, n, l->work->cell, decision));
  else
    KZ_TRY(kz_label_at(&labeller, l->level, l->before_level, n, l->work->cell, decision));
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_cell_label){.periods = (uint32_t)decision[i].periods,
                             .label = (int16_t)decision[i].label,
                             .other = (int16_t)decision[i].other,
                             .evidence = direct && decision[i].level == KZ_LEVELS ? KZ_LEFT : kz_level_evidence(l->level)};
  return KZ_OK;
}

kz_status kz_label_cells(kz_window_labels *l, int64_t first, const int64_t *cells, int64_t n, kz_cell_label *out) {
  for (int64_t done = 0; done < n; done += l->batch) {
    const int64_t part = n - done < l->batch ? n - done : l->batch;
    KZ_TRY(kz_ranks_interrupted(l->run->ranks));
    for (int64_t i = 0; i < part; i++) l->work->cell[i] = cells ? cells[done + i] : first + done + i;
    if (l->plan->method != KZ_METHOD_ICM)
      KZ_TRY(label_batch(l, part, out + done));
    else
      follow_batch(l, part, out + done);
  }
  return KZ_OK;
}

/* The attractors among n cells: their numbers, each once. */
static int64_t list_reached(int64_t n, const kz_cell_label *cell, int32_t *number) {
  bool seen[INT16_MAX + 1] = {false};
  int64_t count = 0;
  for (int64_t i = 0; i < n; i++) {
    if (cell[i].label <= 0 || seen[cell[i].label]) continue;
    seen[cell[i].label] = true;
    number[count++] = cell[i].label;
  }
  return count;
}

size_t kz_tile_labels_bytes(const kz_window_labels *l) {
  const size_t n = (size_t)kz_tile_capacity(&l->tiles);
  return sizeof(head) + n * sizeof(int32_t) + kz_pack_bytes(n, sizeof(kz_cell_label));
}

kz_status kz_tile_labels_pack(const kz_window_labels *l, int64_t tile, void *record) {
  const int64_t n = kz_tile_own(&l->tiles, tile);
  head *h = record;
  int32_t *number = (int32_t *)(h + 1);
  *h = (head){.n_reached = list_reached(n, l->cell, number)};
  for (int64_t i = 0; i < n; i++) {
    h->n_pending += l->cell[i].label == 0;
    h->n_doubtful += l->cell[i].label == KZ_DOUBTFUL;
  }
  const size_t bytes = kz_squeeze(l->cell, (size_t)n, sizeof *l->cell, number + h->n_reached);
  h->bytes = sizeof *h + (size_t)h->n_reached * sizeof *number + bytes;
  return bytes > 0 ? KZ_OK : kz_fail(KZ_FAILED, "no memory to pack a tile of %lld cells", (long long)n);
}

kz_status kz_tile_labels_replace(const kz_window_labels *l, kz_local_record *kept, void *record) {
  kz_local_records packed = {0};
  KZ_TRY(kz_tile_labels_pack(l, kept->tile, record));
  kz_local_records_add(&packed, kept->tile, record, *(uint64_t *)record);
  free(kept->data);
  *kept = packed.list[0];
  free(packed.list);
  return KZ_OK;
}

kz_status kz_tile_labels_unpack(kz_window_labels *l, const kz_local_record *kept) {
  const head *h = kept->data;
  const char *packed = (const char *)(h + 1) + (size_t)h->n_reached * sizeof(int32_t);
  const size_t bytes = kept->bytes - (size_t)(packed - (const char *)kept->data);
  if (kz_unsqueeze(packed, bytes, (size_t)kz_tile_own(&l->tiles, kept->tile), sizeof *l->cell, l->cell)) return KZ_OK;
  return kz_fail(KZ_FAILED, "a packed tile of %lld cells is damaged, or memory ran out",
                 (long long)kz_tile_own(&l->tiles, kept->tile));
}

int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted) {
  const head *h = kept->data;
  return wanted == 0 ? h->n_pending : h->n_doubtful;
}

void kz_tile_labels_note_reached(const kz_window_labels *l, const kz_local_record *kept) {
  const head *h = kept->data;
  const int32_t *number = (const int32_t *)(h + 1);
  for (int64_t i = 0; i < h->n_reached; i++) l->reached[number[i]]++;
}
