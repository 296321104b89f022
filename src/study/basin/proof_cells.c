/* Labels that are proved: the start of each cell is followed into the region, in doubles and, where its set grows too large, in pairs of
 * doubles and at last in quad precision. Tiles are taken some at a time, so that what all ranks know of them stays small. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "label_parts.h"
#include "proof.h"

enum { MOST_CELLS = 1 << 22 }; /* of tiles that are taken together */

/* What takes the cells that a coarser precision leaves. */
typedef struct {
  const char *stage;
  int32_t precision;
  int64_t tile; /* cells that it takes at a time */
  uint8_t evidence;
} finer_stage;
static const finer_stage finer_ones[] = {{"proof in pairs", KZ_ENCLOSE_PAIRS, 1024, KZ_PROVED_IN_PAIRS},
                                         {"proof in quads", KZ_ENCLOSE_QUADS, 32, KZ_PROVED_IN_QUADS}};

/* Tiles from .. to - 1, and the stage that works on them. */
typedef struct {
  const kz_window_labels *labelling;
  const kz_proof *proof;
  const kz_proved *proved;
  int64_t from, to, first, n; /* tiles; first cell, cells */
  uint64_t *wanted;           /* [n] bits */
  uint8_t *number, *evidence; /* [n] */
  const finer_stage *finer;   /* of the present stage */
  int64_t n_left, *left;      /* cells that coarser precisions leave */
} part;

static bool is_wanted(const part *p, int64_t i) {
  return p->wanted[i / 64] >> (i % 64) & 1;
}

kz_proof_start kz_proof_cell_start(const kz_basin_plan *plan, int64_t cell) {
  kz_proof_start start;
  const double theta = kz_axis_place(&plan->theta, cell % plan->theta.count, start.theta);
  const double velocity = kz_axis_place(&plan->velocity, cell / plan->theta.count, start.velocity);
  start.radius = fmax(theta, velocity);
  return start;
}

/* Each rank knows the labels of its own tiles: all then know which cells are wanted. */
static kz_status find_wanted(kz_window_labels *l, part *p) {
  memset(p->wanted, 0, (size_t)(p->n / 64 + 1) * sizeof *p->wanted);
  for (int64_t i = 0; i < l->records.n; i++) {
    const int64_t tile = l->records.list[i].tile, before = kz_tile_first(&l->tiles, tile) - p->first;
    if (tile < p->from || tile >= p->to) continue;
    KZ_TRY(kz_tile_labels_unpack(l, &l->records.list[i]));
    for (int64_t k = 0; k < kz_tile_own(&l->tiles, tile); k++) {
      const int16_t label = l->cell[k].label;
      if (label <= 0 || (label <= KZ_PROOF_MOST && p->proved->has[label]))
        p->wanted[(before + k) / 64] |= (uint64_t)1 << (before + k) % 64;
    }
  }
  return KZ_OK;
}

/* Follows n wanted cells; number [n]. */
static void follow(const part *p, int32_t precision, int64_t n, const int64_t *cell, uint8_t *number) {
  kz_proof_start *start = kz_malloc((size_t)n * sizeof *start + 1);
  for (int64_t i = 0; i < n; i++) start[i] = kz_proof_cell_start(p->labelling->plan, cell[i]);
  kz_proof_follow(p->proof, precision, n, start, kz_proof_periods(p->labelling->plan), number);
  free(start);
}

static kz_status follow_tile(void *context, int64_t tile, void *record) {
  const part *p = context;
  const kz_tiles *tiles = &p->labelling->tiles;
  const int64_t first = kz_tile_first(tiles, p->from + tile), n = kz_tile_own(tiles, p->from + tile);
  int64_t *cell = kz_malloc((size_t)n * sizeof *cell + 1), count = 0;
  uint8_t *number = kz_malloc((size_t)n + 1), *out = record;
  for (int64_t i = 0; i < n; i++)
    if (is_wanted(p, first - p->first + i)) cell[count++] = first + i;
  follow(p, KZ_ENCLOSE_DOUBLES, count, cell, number);
  for (int64_t i = 0; i < count; i++) out[cell[i] - first] = number[i];
  free(cell);
  free(number);
  return KZ_OK;
}

static kz_status follow_left(void *context, int64_t tile, void *record) {
  const part *p = context;
  const int64_t most = p->finer->tile, first = tile * most, n = p->n_left - first < most ? p->n_left - first : most;
  follow(p, p->finer->precision, n, p->left + first, record);
  return KZ_OK;
}

static void take(part *p, int64_t i, uint8_t number, uint8_t evidence) {
  if (number == 0 || number == KZ_PROOF_LATE) return;
  p->number[i] = number;
  p->evidence[i] = evidence;
}

/* All tiles of the part in doubles; a record has the place of whole tiles. */
static kz_status prove_in_doubles(const kz_run *run, part *p) {
  const kz_tiles *tiles = &p->labelling->tiles;
  const size_t capacity = (size_t)kz_tile_capacity(tiles);
  const kz_stage stage = kz_stage_for_all("proof in doubles", p->to - p->from, capacity, follow_tile, p);
  uint8_t *record = kz_malloc((size_t)stage.n_tiles * capacity);
  const kz_status status = kz_stage_run(run, &stage, record);
  p->n_left = 0;
  for (int64_t tile = p->from; status == KZ_OK && tile < p->to; tile++) {
    const uint8_t *of = record + (size_t)(tile - p->from) * capacity;
    const int64_t before = kz_tile_first(tiles, tile) - p->first;
    for (int64_t k = 0; k < kz_tile_own(tiles, tile); k++) {
      take(p, before + k, of[k], KZ_PROVED);
      if (of[k] == 0 && is_wanted(p, before + k)) p->left[p->n_left++] = p->first + before + k;
    }
  }
  free(record);
  return status;
}

static kz_status prove_left(const kz_run *run, const finer_stage *finer, part *p) {
  const kz_stage stage =
      kz_stage_for_all(finer->stage, (p->n_left + finer->tile - 1) / finer->tile, (size_t)finer->tile, follow_left, p);
  p->finer = finer;
  uint8_t *record = kz_malloc((size_t)stage.n_tiles * stage.record_bytes + 1);
  const kz_status status = kz_stage_run(run, &stage, record);
  int64_t n_left = 0;
  for (int64_t i = 0; status == KZ_OK && i < p->n_left; i++) {
    take(p, p->left[i] - p->first, record[i], finer->evidence);
    if (record[i] == 0) p->left[n_left++] = p->left[i];
  }
  p->n_left = n_left;
  free(record);
  return status;
}

/* Into the tiles of this rank. */
static kz_status keep(kz_window_labels *l, const part *p, void *record) {
  for (int64_t i = 0; i < l->records.n; i++) {
    kz_local_record *packed = &l->records.list[i];
    if (packed->tile < p->from || packed->tile >= p->to) continue;
    const int64_t before = kz_tile_first(&l->tiles, packed->tile) - p->first;
    KZ_TRY(kz_tile_labels_unpack(l, packed));
    for (int64_t k = 0; k < kz_tile_own(&l->tiles, packed->tile); k++) {
      l->cell[k].proof = p->evidence[before + k];
      l->cell[k].proved = p->number[before + k];
    }
    KZ_TRY(kz_tile_labels_replace(l, packed, record));
  }
  return KZ_OK;
}

static kz_status prove_part(kz_window_labels *l, part *p) {
  const kz_run *run = l->run;
  memset(p->number, 0, (size_t)p->n);
  memset(p->evidence, 0, (size_t)p->n);
  KZ_TRY(kz_ranks_agree(run->ranks, find_wanted(l, p)));
  KZ_TRY(kz_ranks_sum(run->ranks, (int64_t *)p->wanted, p->n / 64 + 1));
  KZ_TRY(prove_in_doubles(run, p));
  for (size_t i = 0; i < sizeof finer_ones / sizeof *finer_ones; i++) KZ_TRY(prove_left(run, &finer_ones[i], p));
  void *record = kz_malloc(kz_tile_labels_bytes(l));
  const kz_status status = keep(l, p, record);
  free(record);
  return kz_ranks_agree(run->ranks, status);
}

/* Follows the starts of all cells into the region, in kept stages, and sets the fields `proof` and `proved` of the cells. Cells whose label
 * is an attractor that is not proved are left out. Collective. */
static kz_status prove_cells(kz_window_labels *l, const kz_proof *proof, const kz_proved *proved) {
  const kz_tiles *tiles = &l->tiles;
  const int64_t capacity = kz_tile_capacity(tiles), at_once = capacity < MOST_CELLS ? MOST_CELLS / capacity : 1;
  const int64_t most = capacity * (at_once < tiles->own ? at_once : tiles->own);
  part p = {.labelling = l, .proof = proof, .proved = proved};
  if (!proved->any) return KZ_OK;
  p.wanted = kz_malloc((size_t)(most / 64 + 1) * sizeof *p.wanted);
  p.number = kz_malloc((size_t)most);
  p.evidence = kz_malloc((size_t)most);
  p.left = kz_malloc((size_t)most * sizeof *p.left);
  kz_status status = KZ_OK;
  for (p.from = 0; p.from < tiles->own && status == KZ_OK; p.from = p.to) {
    p.to = p.from + at_once < tiles->own ? p.from + at_once : tiles->own;
    p.first = kz_tile_first(tiles, p.from);
    p.n = kz_tile_first(tiles, p.to - 1) + kz_tile_own(tiles, p.to - 1) - p.first;
    status = prove_part(l, &p);
  }
  free(p.wanted);
  free(p.number);
  free(p.evidence);
  free(p.left);
  return status;
}

kz_status kz_prove_window(kz_window_labels *labelling, kz_proof *proof, kz_proof_sample *sample) {
  kz_proved proved = {.any = false};
  *sample = (kz_proof_sample){.high = 1};
  KZ_TRY(kz_prove_regions(labelling->run, labelling->dynamics, proof, &proved));
  if (!proved.any) return KZ_OK;
  KZ_TRY(prove_cells(labelling, proof, &proved));
  return kz_prove_sample(labelling->run, labelling->plan, proof, sample);
}
