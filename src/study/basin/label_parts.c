/* Labelling some cells, and packing a whole tile. */
#include <stdlib.h>

#include "label.h"

enum {
  MOST_DECIDED = 100000
}; /* windows of at most so many cells: own orbits decide their pending cells even if basin.undecided is flag */

/* A packed tile; after it its cells as kz_squeeze has them. */
typedef struct {
  uint64_t bytes; /* all */
  int64_t n_pending, n_doubtful;
} head;

void kz_window_labels_start(kz_window_labels *l) {
  kz_window_starts_make(l->plan, l->pendulum, l->dynamics, l->images, &l->starts);
  l->labeller = kz_window_labeller(&l->starts,
                                   l->plan->undecided == KZ_UNDECIDED_DECIDE || (l->images && l->tiles.cells <= MOST_DECIDED));
}

kz_cell_label kz_cell_label_of(const kz_decision *decision, uint8_t evidence) {
  return (kz_cell_label){.periods = (uint32_t)decision->periods,
                         .label = (int16_t)decision->label,
                         .other = (int16_t)decision->other,
                         .evidence = evidence};
}

/* By the map table; by integration with errors; by method direct the labels of states alone, and whether their errors change them. */
static kz_status label_batch(const kz_window_labels *l, int64_t n, const int64_t *cell, kz_decision *decision) {
  const kz_basin_plan *plan = l->plan;
  if (plan->method == KZ_METHOD_ICM) return kz_label_states(&l->labeller, kz_stencil(plan->interpolation), n, cell, decision);
  return kz_label_at(&l->labeller, plan->method == KZ_METHOD_DIRECT ? KZ_LEVEL_GUESS : KZ_LEVEL_DOUBLE, KZ_LEVEL_DOUBLE, n,
                     cell, decision);
}

kz_status kz_label_cells(const kz_window_labels *l, int64_t n, const int64_t *cell, kz_cell_label *out) {
  kz_decision *decision = kz_malloc((size_t)l->batch * sizeof *decision);
  kz_status status = KZ_OK;
  for (int64_t done = 0; done < n && status == KZ_OK; done += l->batch) {
    const int64_t part = n - done < l->batch ? n - done : l->batch;
    status = kz_ranks_interrupted(l->run->ranks);
    if (status == KZ_OK) status = label_batch(l, part, cell + done, decision);
    for (int64_t i = 0; i < part && status == KZ_OK; i++)
      out[done + i] = kz_cell_label_of(decision + i, decision[i].level == KZ_LEVELS ? KZ_LEFT : KZ_FOLLOWED);
  }
  free(decision);
  return status;
}

size_t kz_tile_labels_bytes(const kz_window_labels *l) {
  return sizeof(head) + kz_pack_bytes((size_t)kz_tile_capacity(&l->tiles), sizeof(kz_cell_label));
}

kz_status kz_tile_labels_pack(const kz_window_labels *l, int64_t tile, void *record) {
  const int64_t n = kz_tile_own(&l->tiles, tile);
  head *h = record;
  *h = (head){.bytes = sizeof *h};
  for (int64_t i = 0; i < n; i++) {
    h->n_pending += l->cell[i].label == 0;
    h->n_doubtful += l->cell[i].label == KZ_DOUBTFUL;
  }
  const size_t bytes = kz_squeeze(l->cell, (size_t)n, sizeof *l->cell, h + 1);
  h->bytes += bytes;
  return bytes > 0 ? KZ_OK : kz_fail(KZ_FAILED, "no memory to pack a tile of %lld cells", (long long)n);
}

kz_status kz_tile_labels_replace(const kz_window_labels *l, kz_local_record *kept) {
  void *record = kz_malloc(kz_tile_labels_bytes(l));
  const kz_status status = kz_tile_labels_pack(l, kept->tile, record);
  free(kept->data);
  kept->bytes = *(uint64_t *)record;
  kept->data = kz_realloc(record, kept->bytes);
  return status;
}

kz_status kz_tile_labels_unpack(kz_window_labels *l, const kz_local_record *kept) {
  const int64_t n = kz_tile_own(&l->tiles, kept->tile);
  if (kz_unsqueeze((const head *)kept->data + 1, kept->bytes - sizeof(head), (size_t)n, sizeof *l->cell, l->cell)) return KZ_OK;
  return kz_fail(KZ_FAILED, "a packed tile of %lld cells is damaged, or memory ran out", (long long)n);
}

int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted) {
  const head *h = kept->data;
  return wanted == 0 ? h->n_pending : h->n_doubtful;
}
