/* The labeller of a window, and packing a whole tile. */
#include "label.h"

/* Bytes between members would be anything, and packed as such: it took a tenth of the time of a window. */
_Static_assert(sizeof(kz_label) == sizeof(int64_t) + 3 * sizeof(int16_t) + 2 * sizeof(uint8_t) + 2 * sizeof(int32_t),
               "no gaps");

/* A packed tile; then the numbers of the attractors it reaches (int32_t) and its cells packed by kz_squeeze. */
typedef struct {
  uint64_t bytes; /* all */
  int64_t n_reached, n_pending, n_doubtful;
} head;

kz_status kz_window_labels_start(kz_window_labels *l) {
  kz_cell_starts_make(l->plan, &l->starts);
  l->labeller = kz_cell_starts_labeller(&l->starts, l->dynamics);
  for (const kz_part *p = l->parts; p < l->parts + l->n_parts; p++)
    if (p->part->label) KZ_TRY(p->part->label(p->own, l));
  l->labeller.way = kz_way_of(l->plan->method);
  l->labeller.stepper = kz_stepper_of(l->plan->method, l->plan->interpolation);
  l->labeller.run = l->run;
  l->labeller.tile = l->tile;
  l->labeller.turns = l->plan->turns;
  return KZ_OK;
}

size_t kz_tile_labels_bytes(const kz_window_labels *l) {
  const size_t n = (size_t)kz_tile_capacity(&l->tiles);
  return sizeof(head) + n * sizeof(int32_t) + kz_pack_bytes(n, sizeof(kz_label));
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
