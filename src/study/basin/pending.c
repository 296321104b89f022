/* Pending cells, unsettled or doubtful: counted, picked and labelled again, a bounded number at a time. */
#include <string.h>

#include "label.h"

enum { MOST_PENDING = 1 << 20 }; /* cells that a rank lists at a time; more than a tile has */

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

kz_status kz_pending_pick(kz_window_labels *l, int64_t from, int64_t of, int64_t n, int64_t *cell, int64_t *level) {
  kz_status status = KZ_OK;
  memset(cell, 0, (size_t)n * sizeof *cell);
  if (level) memset(level, 0, (size_t)n * sizeof *level);
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++)
    status = pick_from(l, &l->records.list[i], from, of, n, cell, level);
  KZ_TRY(kz_ranks_agree(l->run->ranks, status));
  if (level) KZ_TRY(kz_ranks_sum(l->run->ranks, level, n));
  return kz_ranks_sum(l->run->ranks, cell, n);
}

/* The new labels of the listed cells, of which the first is pending cell `from`, replace those of a tile of this rank. */
static kz_status merge(kz_window_labels *l, kz_local_record *packed, int64_t from, int64_t n, const kz_label *found) {
  int64_t number = l->before[packed->tile] - from;
  const int64_t end = l->before[packed->tile + 1] - from;
  if (number < 0 || number == end || end > n) return KZ_OK;
  KZ_TRY(kz_tile_labels_unpack(l, packed));
  for (int64_t k = 0; number < end; k++)
    if (l->cell[k].label == l->wanted) l->cell[k] = found[number++];
  return kz_tile_labels_replace(l, packed);
}

/* The n pending cells from `from` on, which are those of whole tiles. */
static kz_status label_tiles(kz_window_labels *l, int round, int64_t from, int64_t n, int64_t *cell) {
  KZ_FREED int64_t *level = kz_malloc((size_t)n * sizeof *level);
  KZ_FREED kz_label *found = kz_malloc((size_t)n * sizeof *found);
  KZ_TRY(kz_pending_pick(l, from, n, n, cell, level));
  for (int64_t i = 0; i < n; i++) found[i] = (kz_label){.label = l->wanted, .next = (uint8_t)level[i]};
  kz_sampling_weigh(l->run, kz_tiles_stand_for(l));
  kz_status status = (l->wanted == 0 ? kz_label_items : kz_label_doubtful)(&l->labeller, round, n, cell, found);
  kz_sampling_weigh(l->run, 1 / kz_tiles_stand_for(l));
  for (int64_t i = 0; i < l->records.n && status == KZ_OK; i++) status = merge(l, &l->records.list[i], from, n, found);
  return kz_ranks_agree(l->run->ranks, status);
}

kz_status kz_pending_label(kz_window_labels *l, int round) {
  const int64_t *before = l->before, all = before[l->tiles.own];
  const int64_t most = all < MOST_PENDING ? all : MOST_PENDING;
  KZ_FREED int64_t *cell = kz_malloc((size_t)most * sizeof *cell + 1);
  kz_status status = KZ_OK;
  for (int64_t from = 0, to; from < l->tiles.own && status == KZ_OK; from = to) {
    for (to = from + 1; to < l->tiles.own && before[to + 1] - before[from] <= most;) to++;
    if (before[to] > before[from]) status = label_tiles(l, round, before[from], before[to] - before[from], cell);
  }
  return status;
}
