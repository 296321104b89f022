/* Labelling some cells, and packing a whole tile. */
#include <stdlib.h>

#include "label.h"

enum {
  MOST_DECIDED = 100000
}; /* windows of at most so many cells: own orbits decide their pending cells even if basin.undecided is flag */

/* A packed tile. After it: the numbers of the attractors that it reaches (int32_t), its cells as kz_squeeze has them. */
typedef struct {
  uint64_t bytes; /* all */
  int64_t n_reached, n_pending, n_doubtful;
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

/* By the map table. */
static kz_status label_by_table(const kz_window_labels *l, int64_t n, const int64_t *cell, kz_cell_label *out) {
  KZ_FREED double *state = kz_malloc(2 * (size_t)n * sizeof *state);
  int32_t *label = kz_malloc((size_t)n * sizeof *label);
  int64_t *periods = kz_malloc((size_t)n * sizeof *periods);
  for (int64_t i = 0; i < n; i++) kz_cell_state(l->plan, cell[i], state + 2 * i);
  kz_dynamics_follow(l->dynamics, kz_stencil(l->plan->interpolation), n, l->plan->max_periods, state, label, periods);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_cell_label){.periods = (uint32_t)periods[i], .label = (int16_t)label[i], .evidence = KZ_FOLLOWED};
  free(label);
  free(periods);
  return KZ_OK;
}

/* By integration with errors; by method direct the labels of states alone, and whether their errors change them. */
static kz_status label_by_level(const kz_window_labels *l, int64_t n, const int64_t *cell, kz_cell_label *out) {
  const int32_t level = l->plan->method == KZ_METHOD_DIRECT ? KZ_LEVEL_GUESS : KZ_LEVEL_DOUBLE;
  KZ_FREED kz_decision *decision = kz_malloc((size_t)n * sizeof *decision);
  KZ_TRY(kz_label_at(&l->labeller, level, KZ_LEVEL_DOUBLE, n, cell, decision));
  for (int64_t i = 0; i < n; i++)
    out[i] = kz_cell_label_of(decision + i, decision[i].level == KZ_LEVELS ? KZ_LEFT : KZ_FOLLOWED);
  return KZ_OK;
}

kz_status kz_label_cells(const kz_window_labels *l, int64_t n, const int64_t *cell, kz_cell_label *out) {
  for (int64_t done = 0; done < n; done += l->batch) {
    const int64_t part = n - done < l->batch ? n - done : l->batch;
    KZ_TRY(kz_ranks_interrupted(l->run->ranks));
    KZ_TRY((l->plan->method == KZ_METHOD_ICM ? label_by_table : label_by_level)(l, part, cell + done, out + done));
  }
  return KZ_OK;
}

size_t kz_tile_labels_bytes(const kz_window_labels *l) {
  const size_t n = (size_t)kz_tile_capacity(&l->tiles);
  return sizeof(head) + n * sizeof(int32_t) + kz_pack_bytes(n, sizeof(kz_cell_label));
}

kz_status kz_tile_labels_pack(const kz_window_labels *l, int64_t tile, void *record) {
  const int64_t n = kz_tile_own(&l->tiles, tile);
  bool seen[INT16_MAX + 1] = {false};
  head *h = record;
  int32_t *number = (int32_t *)(h + 1);
  *h = (head){.bytes = 0};
  for (int64_t i = 0; i < n; i++) {
    const int16_t label = l->cell[i].label;
    h->n_pending += label == 0;
    h->n_doubtful += label == KZ_DOUBTFUL;
    if (label <= 0 || seen[label]) continue;
    seen[label] = true;
    number[h->n_reached++] = label;
  }
  const size_t bytes = kz_squeeze(l->cell, (size_t)n, sizeof *l->cell, number + h->n_reached);
  h->bytes = sizeof *h + (size_t)h->n_reached * sizeof *number + bytes;
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
  const head *h = kept->data;
  const size_t before = sizeof *h + (size_t)h->n_reached * sizeof(int32_t);
  if (kz_unsqueeze((const char *)h + before, kept->bytes - before, (size_t)n, sizeof *l->cell, l->cell)) return KZ_OK;
  return kz_fail(KZ_FAILED, "a packed tile of %lld cells is damaged, or memory ran out", (long long)n);
}

int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted) {
  const head *h = kept->data;
  return wanted == 0 ? h->n_pending : h->n_doubtful;
}

void kz_tile_labels_note_reached(const kz_window_labels *l, const kz_local_record *kept) {
  const head *h = kept->data;
  for (int64_t i = 0; i < h->n_reached; i++) l->reached[((const int32_t *)(h + 1))[i]]++;
}
