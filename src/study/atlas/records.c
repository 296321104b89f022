/* Records of varying length: curves and seeds, gathered on all ranks in the order of their tiles. */
#include "curves.h"
#include "records.h"

void kz_atlas_bag_free(kz_atlas_bag *b) {
  for (int64_t i = 0; i < b->n; i++) free(b->record[i]);
  free(b->record);
  *b = (kz_atlas_bag){0};
}

static void bag_put(kz_atlas_bag *b, int64_t tile, const void *record) {
  const uint64_t bytes = *(const uint64_t *)record;
  b->record[tile] = memcpy(kz_malloc(bytes), record, bytes);
}

static kz_status records_take(void *context, int64_t tile, const void *record, size_t bytes) {
  (void)bytes;
  bag_put(context, tile, record);
  return KZ_OK;
}

/* All ranks get the records of rank 0. Collective. */
static kz_status records_share(const kz_run *run, kz_atlas_bag *b) {
  KZ_AUTOFREE uint64_t *bytes = kz_calloc((size_t)b->n + 1, sizeof *bytes);
  const bool here = kz_rank(run->ranks) == 0;
  for (int64_t i = 0; here && i < b->n; i++) memcpy(bytes + i, b->record[i], sizeof *bytes);
  KZ_TRY(kz_ranks_broadcast(run->ranks, bytes, (size_t)b->n * sizeof *bytes));
  for (int64_t i = 0; i < b->n; i++) {
    if (!here) b->record[i] = kz_malloc(bytes[i]);
    KZ_TRY(kz_ranks_broadcast(run->ranks, b->record[i], bytes[i]));
  }
  return KZ_OK;
}

/* Runs a stage whose records have different lengths. Collective. */
kz_status kz_atlas_gather(const kz_run *run, const char *name, int64_t n, size_t bytes, kz_tile_fn work, void *context,
                          kz_atlas_bag *b) {
  *b = (kz_atlas_bag){n, kz_calloc((size_t)n + 1, sizeof *b->record)};
  const kz_stage stage = {
      .name = name, .n_tiles = n, .record_bytes = bytes, .work = work, .context = context, .keep = true};
  KZ_TRY(kz_stage_gather(run, &stage, name, records_take, b));
  return records_share(run, b);
}

typedef struct {
  uint64_t bytes;
  int64_t dropped;
} seeds_head;

void kz_atlas_put_seeds(const kz_atlas_seeds *seeds, void *record) {
  const size_t most = (KZ_ATLAS_SEEDS_BYTES - sizeof(seeds_head)) / sizeof *seeds->list,
               n = (size_t)seeds->count < most ? (size_t)seeds->count : most;
  const seeds_head head = {sizeof head + n * sizeof *seeds->list, seeds->dropped + seeds->count - (int64_t)n};
  memcpy(record, &head, sizeof head);
  if (n > 0) memcpy((char *)record + sizeof head, seeds->list, n * sizeof *seeds->list);
}

/* The seeds of a record; they stay where they are. */
kz_atlas_seeds kz_atlas_seeds_in(const char *record) {
  seeds_head head;
  memcpy(&head, record, sizeof head);
  return (kz_atlas_seeds){.count = (int64_t)((head.bytes - sizeof head) / sizeof(kz_cycle)),
                          .list = (kz_cycle *)(void *)(record + sizeof head),
                          .dropped = head.dropped};
}

typedef struct {
  uint64_t bytes;
  kz_cycle_kind kind;
  int32_t ending[2], unused;
  int64_t n, n_special;
} curve_head;

void kz_atlas_put_curve(const kz_atlas_curve *curve, void *record) {
  const size_t rows = (size_t)curve->n * sizeof *curve->row,
               special = (size_t)curve->n_special * sizeof *curve->special;
  const curve_head head = {
      sizeof head + rows + special, curve->kind, {curve->ending[0], curve->ending[1]}, 0, curve->n, curve->n_special};
  memcpy(record, &head, sizeof head);
  memcpy((char *)record + sizeof head, curve->row, rows);
  memcpy((char *)record + sizeof head + rows, curve->special, special);
}

kz_atlas_curve kz_atlas_curve_in(const char *record) {
  curve_head head;
  memcpy(&head, record, sizeof head);
  const size_t rows = (size_t)head.n * sizeof(kz_curve_row), special = (size_t)head.n_special * sizeof(kz_cycle);
  return (kz_atlas_curve){.kind = head.kind,
                          .ending = {head.ending[0], head.ending[1]},
                          .n = head.n,
                          .n_special = head.n_special,
                          .row = memcpy(kz_malloc(rows + 1), record + sizeof head, rows),
                          .special = memcpy(kz_malloc(special + 1), record + sizeof head + rows, special)};
}
