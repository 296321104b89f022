/* Labels that are proved: starts are followed into the region, in doubles and, where their sets grow too large, in sums
 * of two doubles and at last of three. The starts are the cells - of some tiles at a time, so that what all ranks know
 * of them stays small - and random real starts of the window, which bound the share of its area that may end elsewhere
 * than on attractors that are proved. */
#include "proof.h"

enum {
  MOST_CELLS = 1 << 22, /* Cells of tiles that are taken together */
  MOST_STARTS = 50000,  /* random ones */
  TILE = 4096,          /* Cells of a tile */
  PERIODS = 2000        /* for which starts are followed at least, whatever basin.max_periods is */
};

const kz_level kz_proof_levels[KZ_ENCLOSURES] = {
    [KZ_ENCLOSE_DOUBLES] = {.stage = "proof in doubles", .evidence = KZ_PROVED, .tile = 8192},
    [KZ_ENCLOSE_PAIRS] = {.stage = "proof in pairs", .evidence = KZ_PROVED_IN_PAIRS, .tile = 1024},
    [KZ_ENCLOSE_TRIPLES] = {.stage = "proof in triples", .evidence = KZ_PROVED_IN_TRIPLES, .tile = 64},
};

/* Tiles from .. to - 1. */
typedef struct {
  const kz_window_labels *labelling;
  const kz_proof *proof;
  const kz_proved *proved;
  int64_t from, to, first, n; /* tiles; first cell, cells */
  uint64_t *wanted;           /* [n] bits */
  kz_proof_mark *mark;        /* [n] */
  int64_t n_left, *left;      /* cells to prove */
} part;

static kz_proof_start start_of_cell(const kz_basin_plan *plan, int64_t cell) {
  kz_proof_start start;
  const double theta = kz_axis_place(&plan->theta, cell % plan->theta.count, start.theta);
  const double velocity = kz_axis_place(&plan->velocity, cell / plan->theta.count, start.velocity);
  start.radius = fmax(theta, velocity);
  return start;
}

static int64_t periods_of(const kz_basin_plan *plan) {
  return kz_larger(plan->max_periods, PERIODS);
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

/* The labels of n starts at a level: 0 = no proof within the periods. */
static void prove_starts(const kz_basin_plan *plan, const kz_proof *proof, int32_t level, int64_t n,
                         const kz_proof_start *start, kz_decision *decision) {
  KZ_AUTOFREE uint8_t *number = kz_malloc((size_t)n + 1);
  kz_proof_follow(proof, level, n, start, periods_of(plan), number);
  for (int64_t i = 0; i < n; i++)
    decision[i] = (kz_decision){
        .end.label = number[i] == 0               ? KZ_DOUBTFUL
                     : number[i] == KZ_PROOF_LATE ? 0
                                                  : number[i],
    };
}

/* Level of kz_added_levels for cells as items. */
static kz_status prove_at(void *context, int32_t level, int64_t n, const int64_t *cell, kz_decision *decision) {
  const part *p = context;
  KZ_AUTOFREE kz_proof_start *start = kz_malloc((size_t)n * sizeof *start);
  for (int64_t i = 0; i < n; i++) start[i] = start_of_cell(p->labelling->plan, cell[i]);
  prove_starts(p->labelling->plan, p->proof, level, n, start, decision);
  return KZ_OK;
}

static kz_status prove_left(const kz_run *run, part *p) {
  static const kz_added_levels levels = {kz_proof_levels, KZ_ENCLOSURES, prove_at};
  const kz_labeller labeller = {.way = KZ_BY_ADDED, .context = p, .added = &levels, .run = run};
  KZ_AUTOFREE kz_label *label = kz_malloc((size_t)p->n_left * sizeof *label + 1);
  KZ_TRY(kz_label_items(&labeller, 1, p->n_left, p->left, label));
  for (int64_t i = 0; i < p->n_left; i++) {
    if (label[i].label <= 0) continue;
    p->mark[p->left[i] - p->first] = (kz_proof_mark){(uint8_t)label[i].label, label[i].evidence};
  }
  return KZ_OK;
}

/* The marks of the tiles of this rank. */
static kz_status cells_keep(const kz_window_labels *l, const part *p, kz_proof_work *run) {
  for (int64_t i = 0; i < l->records.n; i++) {
    const int64_t tile = l->records.list[i].tile;
    if (tile < p->from || tile >= p->to) continue;
    const size_t n = (size_t)kz_tile_own(&l->tiles, tile);
    void *packed = kz_malloc(kz_pack_bytes(n, sizeof *p->mark));
    const size_t bytes = kz_squeeze(p->mark + kz_tile_first(&l->tiles, tile) - p->first, n, sizeof *p->mark, packed);
    run->tile[tile] = (kz_proof_tile){bytes, kz_realloc(packed, bytes + 1)};
    if (bytes == 0) return kz_fail(KZ_FAILED, "no memory to pack a tile of %zu cells", n);
  }
  return KZ_OK;
}

kz_status kz_proof_take(const kz_proof_work *run, int64_t tile, kz_label *cell) {
  const kz_proof_tile *kept = run->tile ? run->tile + tile : NULL;
  if (!kept || kept->bytes == 0) return KZ_OK;
  const int64_t n = kz_tile_own(&run->tiles, tile);
  KZ_AUTOFREE kz_proof_mark *mark = kz_malloc((size_t)n * sizeof *mark);
  if (!kz_unsqueeze(kept->marks, kept->bytes, (size_t)n, sizeof *mark, mark))
    return kz_fail(KZ_FAILED, "a packed tile of %lld cells is damaged, or memory ran out", (long long)n);
  for (int64_t i = 0; i < n; i++) {
    if (mark[i].evidence == 0) continue;
    cell[i].label = mark[i].number;
    cell[i].other = 0;
    cell[i].evidence = mark[i].evidence;
  }
  return KZ_OK;
}

static kz_status prove_part(kz_window_labels *l, part *p, kz_proof_work *kept) {
  const kz_run *run = l->run;
  memset(p->mark, 0, (size_t)p->n * sizeof *p->mark);
  KZ_TRY(kz_ranks_agree(run->ranks, find_wanted(l, p)));
  KZ_TRY(kz_ranks_sum(run->ranks, (int64_t *)p->wanted, p->n / 64 + 1));
  p->n_left = 0;
  for (int64_t i = 0; i < p->n; i++)
    if (p->wanted[i / 64] >> (i % 64) & 1) p->left[p->n_left++] = p->first + i;
  KZ_TRY(prove_left(run, p));
  return kz_ranks_agree(run->ranks, cells_keep(l, p, kept));
}

/* Follows the starts of all cells into the region, in kept stages, and keeps their marks. Cells whose label
 * is an attractor that is not proved are left out. Collective. */
static kz_status prove_cells(kz_window_labels *l, kz_proof_work *run, const kz_proved *proved) {
  const kz_tiles *tiles = &l->tiles;
  const int64_t capacity = kz_tile_capacity(tiles), at_once = capacity < MOST_CELLS ? MOST_CELLS / capacity : 1;
  const int64_t most = capacity * kz_smaller(at_once, tiles->own);
  run->tile = kz_calloc((size_t)tiles->own, sizeof *run->tile);
  KZ_AUTOFREE uint64_t *wanted = kz_malloc((size_t)(most / 64 + 1) * sizeof *wanted);
  KZ_AUTOFREE kz_proof_mark *mark = kz_malloc((size_t)most * sizeof *mark);
  KZ_AUTOFREE int64_t *left = kz_malloc((size_t)most * sizeof *left);
  part p = {l, run->proof, proved, .wanted = wanted, .mark = mark, .left = left};
  for (p.from = 0; p.from < tiles->own; p.from = p.to) {
    p.to = p.from + at_once < tiles->own ? p.from + at_once : tiles->own;
    p.first = kz_tile_first(tiles, p.from);
    p.n = kz_tile_first(tiles, p.to - 1) + kz_tile_own(tiles, p.to - 1) - p.first;
    KZ_TRY(prove_part(l, &p, run));
  }
  return KZ_OK;
}

/* ---- random real starts ---- */

typedef struct {
  const kz_basin_plan *plan;
  const kz_proof *proof;
  int64_t starts;
} job;

/* Start i: drawn to 106 binary digits; a square around it holds the rest of them. */
static kz_proof_start random_start(const kz_basin_plan *plan, int64_t i) {
  kz_proof_start start = {.radius = 0};
  uint64_t bits[4];
  for (int b = 0; b < 4; b++)
    bits[b] = kz_random_bits(((uint64_t)plan->seed << 32) + 4 * (uint64_t)i + (uint64_t)b + 1) >> 11;
  const double theta = kz_axis_random(&plan->theta, bits, start.theta);
  const double velocity = kz_axis_random(&plan->velocity, bits + 2, start.velocity);
  start.radius = theta > velocity ? theta : velocity;
  return start;
}

static int64_t random_starts(const kz_basin_plan *plan) {
  const int64_t cells = plan->theta.count * plan->velocity.count;
  return kz_smaller(cells, MOST_STARTS);
}

/* Level of kz_added_levels for random starts as items. */
static kz_status prove_random(void *context, int32_t level, int64_t n, const int64_t *item, kz_decision *decision) {
  const job *j = context;
  KZ_AUTOFREE kz_proof_start *start = kz_malloc((size_t)n * sizeof *start);
  for (int64_t i = 0; i < n; i++) start[i] = random_start(j->plan, item[i]);
  prove_starts(j->plan, j->proof, level, n, start, decision);
  return KZ_OK;
}

/* Record: how many of the tile's starts are not proved; triples are not tried. */
static kz_status follow_random(void *context, int64_t first, int64_t n, void *record) {
  static const kz_added_levels levels = {kz_proof_levels, KZ_ENCLOSE_TRIPLES, prove_random};
  const kz_labeller labeller = {.way = KZ_BY_ADDED, .context = context, .added = &levels};
  int64_t item[TILE], unproved = 0;
  KZ_AUTOFREE kz_label *label = kz_malloc(TILE * sizeof *label);
  for (int64_t i = 0; i < n; i++) item[i] = first + i;
  KZ_TRY(kz_label_items(&labeller, 1, n, item, label));
  for (int64_t i = 0; i < n; i++) unproved += label[i].label <= 0;
  *(int64_t *)record = unproved;
  return KZ_OK;
}

static kz_status prove_sample(const kz_run *run, const kz_basin_plan *plan, const kz_proof *proof,
                              kz_proof_sample *sample) {
  job j = {.plan = plan, .proof = proof, .starts = random_starts(plan)};
  const kz_stage stage = kz_stage_of_items("proof of real starts", j.starts, TILE, sizeof(int64_t), follow_random, &j);
  KZ_AUTOFREE int64_t *record = kz_calloc((size_t)stage.n_tiles, sizeof *record);
  KZ_TRY(kz_stage_run(run, &stage, record));
  *sample = (kz_proof_sample){.starts = j.starts};
  for (int64_t tile = 0; tile < stage.n_tiles; tile++) sample->unproved += record[tile];
  sample->high = kz_share_upper(sample->unproved, sample->starts, KZ_PROOF_CONFIDENCE);
  return KZ_OK;
}

kz_status kz_prove_window(kz_proof_work *run, kz_window_labels *labelling) {
  kz_proved proved = {.any = false};
  run->sample = (kz_proof_sample){.high = 1};
  run->tiles = labelling->tiles;
  KZ_TRY(kz_prove_regions(labelling, run->proof, &proved));
  if (!proved.any) return KZ_OK;
  KZ_TRY(prove_cells(labelling, run, &proved));
  return prove_sample(labelling->run, labelling->plan, run->proof, &run->sample);
}
