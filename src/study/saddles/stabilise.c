/* Cycles by way of known ones: where grids of starts are too coarse, points of the cycles that they showed are the seeds. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "saddles.h"

enum { SEEDS = 63, MOST_CYCLES = 512 }; /* of a tile: whole batches of the kernel */

static const double FARTHER = 0.03; /* rad, each round */

typedef struct {
  int64_t count;
  double cycle[3 * MOST_CYCLES];
} found;

typedef struct {
  const kz_pendulum *pendulum;
  const kz_saddles_plan *plan;
  int64_t max_period, n; /* seeds */
  double *seed;          /* [n][2] half-turns, velocity: of short cycles first */
  int64_t *up_to;        /* [max_period + 1] seeds of cycles of up to so many periods */
} seeding;

/* The points of all known cycles; in later rounds beside them, each in its own direction, farther every round: the partner with which a
 * cycle was born is near it. Rank 0. */
static kz_status collect_seeds(const kz_cycle_list *cycles, int round, seeding *s) {
  for (int64_t i = 0; i < cycles->count; i++) s->n += cycles->entries[i].row.period;
  s->seed = malloc(2 * (size_t)(s->n + 1) * sizeof *s->seed);
  if (!s->seed) return kz_fail(KZ_FAILED, "no memory for %lld seeds", (long long)s->n);
  int64_t n = 0;
  for (int64_t period = 1; period <= s->max_period; period++) {
    for (int64_t i = 0; i < cycles->count; i++)
      for (int32_t phase = 0; cycles->entries[i].row.period == period && phase < period; phase++, n++) {
        const double angle = 2 * M_PI * fmod((double)n * 0.61803398874989484820, 1),
                     half_turns = (cycles->entries[i].theta[phase] + round * FARTHER * cos(angle)) / M_PI;
        s->seed[2 * n] = half_turns - 2 * rint(half_turns / 2);
        s->seed[2 * n + 1] = cycles->entries[i].velocity[phase] + round * FARTHER * sin(angle);
      }
    s->up_to[period] = n;
  }
  return KZ_OK;
}

/* Rank 0's seeds on every rank. Collective. */
static kz_status share_seeds(const kz_run *run, seeding *s) {
  KZ_TRY(kz_ranks_broadcast(run->ranks, &s->n, sizeof s->n));
  KZ_TRY(kz_ranks_broadcast(run->ranks, s->up_to, (size_t)(s->max_period + 1) * sizeof *s->up_to));
  if (!s->seed) s->seed = malloc(2 * (size_t)(s->n + 1) * sizeof *s->seed);
  KZ_TRY(kz_ranks_agree(run->ranks, s->seed ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld seeds", (long long)s->n)));
  return kz_ranks_broadcast(run->ranks, s->seed, 2 * (size_t)s->n * sizeof *s->seed);
}

static int64_t tiles_of(const seeding *s, int64_t period) {
  return (s->up_to[period] + SEEDS - 1) / SEEDS;
}

/* Whether a cycle [3] has a point in the window. */
static bool in_window(const kz_plan *map, const kz_saddles_plan *plan, const double cycle[3]) {
  double theta = M_PI * cycle[1], velocity = cycle[2];
  int64_t turns = 0;
  for (int64_t i = 0; i < (int64_t)cycle[0]; i++) {
    const double from_middle = remainder(theta - (plan->theta.min + plan->theta.max) / 2, 2 * M_PI);
    if (fabs(from_middle) <= (plan->theta.max - plan->theta.min) / 2 && velocity >= plan->velocity.min &&
        velocity <= plan->velocity.max)
      return true;
    kz_advance(map, 1, 1, &theta, &velocity, &turns);
  }
  return false;
}

/* Leaves those of n cycles [n][3] that the window holds: how many. */
static int64_t keep_inside(const seeding *s, int64_t n, double *cycle) {
  kz_numerics fine;
  kz_numerics_fine(s->pendulum, &fine);
  kz_plan *map = kz_plan_create(s->pendulum, &fine);
  int64_t kept = 0;
  if (!map) return -1;
  for (int64_t i = 0; i < n; i++)
    if (in_window(map, s->plan, cycle + 3 * i)) memmove(cycle + 3 * kept++, cycle + 3 * i, 3 * sizeof *cycle);
  kz_plan_free(map);
  return kept;
}

static kz_status work(void *context, int64_t tile, void *record) {
  const seeding *s = context;
  found *out = record;
  int64_t period = 1;
  for (; tile >= tiles_of(s, period); period++) tile -= tiles_of(s, period);
  const int64_t first = tile * SEEDS, left = s->up_to[period] - first;
  out->count = kz_dynamics_stabilised_cycles(s->pendulum, period, left < SEEDS ? left : SEEDS, s->seed + 2 * first, MOST_CYCLES,
                                             out->cycle);
  if (out->count > MOST_CYCLES) out->count = MOST_CYCLES; /* the others turn up from other seeds, or in the next round */
  out->count = keep_inside(s, out->count, out->cycle);
  return out->count < 0 ? kz_fail(KZ_FAILED, "no memory for a search of cycles") : KZ_OK;
}

/* What all seeds lead to joins the catalogue of rank 0. */
static kz_status search(const kz_run *run, int round, seeding *s, kz_dynamics *dynamics) {
  const bool here = kz_ranks_own(run->ranks) == 0;
  char name[32];
  snprintf(name, sizeof name, "saddles, more %d", round + 1);
  kz_stage stage = {.name = name, .record_bytes = sizeof(found), .work = work, .context = s, .keep = true};
  for (int64_t period = 1; period <= s->max_period; period++) stage.n_tiles += tiles_of(s, period);
  found *records = here ? malloc((size_t)stage.n_tiles * sizeof *records + 1) : NULL;
  kz_status status =
      kz_ranks_agree(run->ranks, records || !here ? KZ_OK : kz_fail(KZ_FAILED, "no memory for a search of cycles"));
  if (status == KZ_OK && stage.n_tiles > 0) status = kz_stage_run(run, &stage, records);
  for (int64_t tile = 0; status == KZ_OK && here && tile < stage.n_tiles; tile++)
    for (int64_t i = 0; i < records[tile].count; i++) kz_dynamics_add_cycle(dynamics, records[tile].cycle + 3 * i);
  free(records);
  return status;
}

kz_status kz_saddles_stabilise(const kz_scene *scene, const kz_run *run, int round, const kz_cycle_list *cycles,
                               kz_dynamics *dynamics) {
  int64_t up_to[KZ_SADDLES_MAX_PERIOD + 1] = {0};
  seeding s = {.pendulum = &scene->parameters.pendulum,
               .plan = &scene->saddles,
               .max_period = scene->saddles.max_period,
               .up_to = up_to};
  kz_status status = kz_ranks_agree(run->ranks, kz_ranks_own(run->ranks) == 0 ? collect_seeds(cycles, round, &s) : KZ_OK);
  if (status == KZ_OK) status = share_seeds(run, &s);
  if (status == KZ_OK) status = search(run, round, &s, dynamics);
  free(s.seed);
  return status;
}
