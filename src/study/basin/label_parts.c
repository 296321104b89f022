/* Labelling one batch of cells, and a whole tile. */
#include "label_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/store.h"

/* A packed tile. After it: the numbers of the attractors that it reaches (int32_t), its cells as kz_pack has them. */
typedef struct {
  uint64_t bytes; /* all */
  int64_t n_reached, n_open;
} head;

struct kz_workspace {
  double start[2 * KZ_BATCH], state[2 * KZ_BATCH];
  int32_t label[KZ_BATCH], to[KZ_BATCH];
  int64_t periods[KZ_BATCH], place[KZ_BATCH];
  bool undecided[KZ_BATCH];
};

kz_workspace *kz_workspace_make(void) {
  return malloc(sizeof(kz_workspace));
}

/* Integrates the marked ones of n starts from one unit in the last place beside; marked: those that end elsewhere then. */
static void find_undecided(const kz_labelling *l, int64_t n) {
  kz_workspace *w = l->work;
  int64_t asked = 0;
  for (int64_t i = 0; i < n; i++) {
    if (!w->undecided[i]) continue;
    for (int c = 0; c < 2; c++)
      w->state[2 * asked + c] = nextafter(w->start[2 * i + c], copysign(INFINITY, w->start[2 * i + c]));
    w->place[asked++] = i;
  }
  kz_dynamics_follow(l->dynamics, KZ_FOLLOW_DIRECT, asked, l->plan->max_periods, w->state, w->to, w->periods);
  for (int64_t i = 0; i < asked; i++) w->undecided[w->place[i]] = w->to[i] != w->label[w->place[i]];
}

/* Labels the n cells whose states are in work->start. */
static void label_batch(const kz_labelling *l, int64_t n, kz_labelled *out) {
  const kz_basin_plan *plan = l->plan;
  kz_workspace *w = l->work;
  memcpy(w->state, w->start, 2 * (size_t)n * sizeof *w->state);
  kz_dynamics_follow(l->dynamics, kz_way(plan->method, plan->interpolation), n, plan->max_periods, w->state, w->label,
                     w->periods);
  for (int64_t i = 0; i < n; i++) {
    w->undecided[i] = plan->flag_undecided && w->label[i] > 0 && w->periods[i] > 0 && plan->method == KZ_METHOD_DIRECT;
    out[i] = (kz_labelled){.periods = (uint32_t)w->periods[i], .label = (int16_t)w->label[i]};
  }
  if (plan->flag_undecided) find_undecided(l, n);
  for (int64_t i = 0; i < n; i++) out[i].evidence = w->undecided[i] ? KZ_UNDECIDED : KZ_FOLLOWED;
}

kz_status kz_label_cells(const kz_labelling *l, int64_t first, const int64_t *cells, int64_t n, kz_labelled *out) {
  for (int64_t done = 0; done < n; done += l->batch) {
    const int64_t part = n - done < l->batch ? n - done : l->batch;
    KZ_TRY(kz_ranks_interrupted(l->run->ranks));
    for (int64_t i = 0; i < part; i++)
      kz_cell_state(l->plan, cells ? cells[done + i] : first + done + i, l->work->start + 2 * i);
    label_batch(l, part, out + done);
  }
  return KZ_OK;
}

/* The attractors among n cells: their numbers, each once. */
static int64_t list_reached(int64_t n, const kz_labelled *cell, int32_t *number) {
  bool seen[INT16_MAX + 1] = {false};
  int64_t count = 0;
  for (int64_t i = 0; i < n; i++) {
    if (cell[i].label <= 0 || seen[cell[i].label]) continue;
    seen[cell[i].label] = true;
    number[count++] = cell[i].label;
  }
  return count;
}

size_t kz_labels_room(const kz_labelling *l) {
  const size_t n = (size_t)kz_tile_room(&l->tiles);
  return sizeof(head) + n * sizeof(int32_t) + kz_pack_room(n, sizeof(kz_labelled));
}

kz_status kz_labels_pack(const kz_labelling *l, int64_t tile, void *record) {
  const int64_t n = kz_tile_own(&l->tiles, tile);
  head *h = record;
  int32_t *number = (int32_t *)(h + 1);
  *h = (head){.n_reached = list_reached(n, l->cell, number)};
  for (int64_t i = 0; i < n; i++) h->n_open += l->cell[i].label == 0;
  const size_t bytes = kz_pack_into(l->cell, (size_t)n, sizeof *l->cell, number + h->n_reached);
  h->bytes = sizeof *h + (size_t)h->n_reached * sizeof *number + bytes;
  return bytes > 0 ? KZ_OK : kz_fail(KZ_FAILED, "no memory to pack a tile of %lld cells", (long long)n);
}

kz_status kz_labels_unpack(kz_labelling *l, const kz_piece *piece) {
  const head *h = piece->data;
  const char *packed = (const char *)(h + 1) + (size_t)h->n_reached * sizeof(int32_t);
  const size_t bytes = piece->bytes - (size_t)(packed - (const char *)piece->data);
  if (kz_unpack(packed, bytes, (size_t)kz_tile_own(&l->tiles, piece->tile), sizeof *l->cell, l->cell)) return KZ_OK;
  return kz_fail(KZ_FAILED, "no memory to unpack a tile of %lld cells", (long long)kz_tile_own(&l->tiles, piece->tile));
}

int64_t kz_labels_open(const kz_piece *piece) {
  return ((const head *)piece->data)->n_open;
}

void kz_labels_note_reached(const kz_labelling *l, const kz_piece *piece) {
  const head *h = piece->data;
  const int32_t *number = (const int32_t *)(h + 1);
  for (int64_t i = 0; i < h->n_reached; i++) l->reached[number[i]]++;
}
