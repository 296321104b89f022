/* Study `saddles`: rounds of ever finer grids of starts, until the index sums are 0 and a round finds nothing new. */
#include "saddles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cells.h"

enum {
  FIRST_CELLS = 256, /* cells of the first round along the longer side of the window */
  ROUNDS = 3,        /* of grids at most; each halves the cells */
  MORE_ROUNDS = 6,   /* of searches from known cycles, at most */
  ROWS = 8,          /* rows of cells in a tile */
  MOST_CYCLES = 4096 /* of a tile */
};
/* Time of a period of one start with the steps of a scan, s. */
static const double PERIOD_SECONDS = 5e-7;

typedef struct {
  const kz_pendulum *pendulum;
  int64_t max_period, n_theta, n_velocity; /* cells */
  double *theta, *velocity;                /* nodes: one more than cells */
} scan;

typedef struct {
  int64_t count;
  double cycle[3 * MOST_CYCLES];
} scanned;

bool kz_saddles_wanted(const kz_scene *scene) {
  return scene->has_saddles;
}

static double width(const kz_axis *axis) {
  return axis->max - axis->min;
}

/* Cells along an axis whose share of the longer side is `share`. */
static int64_t cells_along(int round, double share) {
  const double cells = ceil(FIRST_CELLS * pow(2, round) * share);
  return cells < 8 ? 8 : (int64_t)cells;
}

/* A window that is its own mirror image: its upper half shows every cycle or the mirror image of it. */
static bool is_mirrored(const kz_saddles_plan *plan) {
  return plan->velocity.min == -plan->velocity.max && (plan->theta.min == -plan->theta.max || width(&plan->theta) == 2 * M_PI);
}

static int64_t cells_of(const kz_saddles_plan *plan, int round, int64_t *n_theta, int64_t *n_velocity) {
  const double longer = fmax(width(&plan->theta), width(&plan->velocity));
  *n_theta = cells_along(round, width(&plan->theta) / longer);
  *n_velocity = cells_along(round, width(&plan->velocity) / longer);
  if (is_mirrored(plan)) *n_velocity = cells_along(round, width(&plan->velocity) / (2 * longer));
  return *n_theta * *n_velocity;
}

kz_cost kz_saddles_cost(const kz_scene *scene) {
  const kz_saddles_plan *plan = &scene->saddles;
  int64_t n_theta, n_velocity;
  double starts = 0;
  for (int round = 0; round < ROUNDS - 1; round++) starts += (double)cells_of(plan, round, &n_theta, &n_velocity);
  const double tiles = (double)n_velocity / ROWS + 1;
  return (kz_cost){.disk_bytes = 1e6 + 2 * tiles * sizeof(scanned),
                   .memory_bytes = 2 * tiles * sizeof(scanned) + 400 * (double)plan->max_period * (double)n_theta,
                   .core_seconds = PERIOD_SECONDS * (double)plan->max_period * starts};
}

static double *nodes(double min, double max, int64_t cells) {
  double *values = malloc((size_t)(cells + 1) * sizeof *values), n = (double)cells;
  for (int64_t i = 0; values && i <= cells; i++) values[i] = (min * (n - (double)i) + max * (double)i) / n;
  return values;
}

static kz_status scan_rows(void *context, int64_t tile, void *record) {
  const scan *s = context;
  scanned *out = record;
  const int64_t first = tile * ROWS, rows = s->n_velocity - first < ROWS ? s->n_velocity - first : ROWS;
  out->count = kz_dynamics_scan_cycles(s->pendulum, s->max_period, s->n_theta + 1, s->theta, rows + 1, s->velocity + first,
                                       MOST_CYCLES, out->cycle);
  if (out->count <= MOST_CYCLES) return KZ_OK;
  return kz_fail(KZ_REFUSED, "saddles.max_period: %lld gives over %d cycles near velocity = %.9g; use a shorter period",
                 (long long)s->max_period, MOST_CYCLES, s->velocity[first]);
}

/* The cycles of all tiles join the catalogue, in the order of the tiles. */
static void collect(kz_dynamics *dynamics, int64_t n_tiles, const scanned *records) {
  for (int64_t tile = 0; tile < n_tiles; tile++)
    for (int64_t i = 0; i < records[tile].count; i++) kz_dynamics_add_cycle(dynamics, records[tile].cycle + 3 * i);
}

/* One round: the catalogue of rank 0 grows. Collective. */
static kz_status run_scan(const kz_run *run, scan *s, int round, kz_dynamics *dynamics) {
  char name[32];
  snprintf(name, sizeof name, "saddles %d", round + 1);
  const kz_stage stage = {.name = name,
                          .n_tiles = (s->n_velocity + ROWS - 1) / ROWS,
                          .record_bytes = sizeof(scanned),
                          .work = scan_rows,
                          .context = s,
                          .keep = true};
  const bool here = kz_ranks_own(run->ranks) == 0;
  scanned *records = here ? malloc((size_t)stage.n_tiles * sizeof *records) : NULL;
  const bool ready = s->theta && s->velocity && (records || !here);
  kz_status status = kz_ranks_agree(run->ranks, ready ? KZ_OK : kz_fail(KZ_FAILED, "no memory for a scan of starts"));
  if (status == KZ_OK) status = kz_stage_run(run, &stage, records);
  if (status == KZ_OK && here) collect(dynamics, stage.n_tiles, records);
  free(records);
  return status;
}

/* A round of grids: the catalogue of rank 0 grows. */
static kz_status run_round(const kz_scene *scene, const kz_run *run, int round, kz_dynamics *dynamics) {
  const kz_saddles_plan *plan = &scene->saddles;
  scan s = {.pendulum = &scene->parameters.pendulum, .max_period = plan->max_period};
  cells_of(plan, round, &s.n_theta, &s.n_velocity);
  s.theta = nodes(plan->theta.min, plan->theta.max, s.n_theta);
  s.velocity = nodes(is_mirrored(plan) ? 0 : plan->velocity.min, plan->velocity.max, s.n_velocity);
  const kz_status status = run_scan(run, &s, round, dynamics);
  free(s.theta);
  free(s.velocity);
  return status;
}

/* What is known now. Rank 0. */
static kz_status list_known(const kz_saddles_plan *plan, const kz_dynamics *dynamics, kz_cycle_list *cycles,
                            kz_index_sums *sums) {
  kz_cycle_list_free(cycles);
  free(sums->entries);
  *sums = (kz_index_sums){0};
  KZ_TRY(kz_cycle_list_make(dynamics, cycles));
  return kz_index_sums_make(cycles, plan->max_period, sums);
}

/* Rounds of grids, then of searches from what they showed, until two agree and the sums are 0; without damping the sums say nothing.
 * Collective. */
static kz_status run_rounds(const kz_scene *scene, const kz_run *run, kz_dynamics *dynamics, kz_cycle_list *cycles,
                            kz_index_sums *sums) {
  int64_t before = -1;
  int32_t enough = 0;
  for (int round = 0; round < ROUNDS + MORE_ROUNDS && !enough; round++) {
    kz_status status = round < ROUNDS ? run_round(scene, run, round, dynamics)
                                      : kz_saddles_stabilise(scene, run, round - ROUNDS, cycles, dynamics);
    if (status == KZ_OK && kz_ranks_own(run->ranks) == 0) status = list_known(&scene->saddles, dynamics, cycles, sums);
    KZ_TRY(kz_ranks_agree(run->ranks, status));
    const bool same = cycles->count == before, undamped = scene->parameters.pendulum.beta <= 0;
    enough = same && (sums->open == 0 || undamped);
    before = cycles->count;
    KZ_TRY(kz_ranks_broadcast(run->ranks, &enough, sizeof enough));
  }
  return KZ_OK;
}

kz_status kz_saddles_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_saddles_plan *plan = &scene->saddles;
  kz_cycle_list cycles = {0};
  kz_index_sums sums = {0};
  kz_dynamics *dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, plan->max_period);
  kz_status status = kz_ranks_agree(run->ranks, dynamics ? KZ_OK : kz_fail(KZ_FAILED, "no memory for a catalogue of cycles"));
  if (status == KZ_OK) status = run_rounds(scene, run, dynamics, &cycles, &sums);
  if (status == KZ_OK && kz_ranks_own(run->ranks) == 0) {
    status = kz_saddles_write(&cycles, &sums, store);
    kz_saddles_print(scene, &cycles, &sums, summary);
  }
  if (dynamics) kz_dynamics_free(dynamics);
  kz_cycle_list_free(&cycles);
  free(sums.entries);
  return status;
}
