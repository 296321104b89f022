/* What a search of cycles takes: a part of its lines is tried with short periods, which tells how the effort grows with the period. */
#include <math.h>
#include <stdlib.h>

#include "lines.h"
#include "saddles.h"

/* Pieces that are tried, with so many starts at most; how often a cycle is found, and in how many pieces; messages and records of
 * pieces that a rank holds. */
enum { SAMPLE_PIECES = 24, SAMPLE_STARTS = 20000, REPEATS = 32, PIECES_OF_A_CYCLE = 8, PIECES_AT_ONCE = 5 };
/* As measured, s: what the effort tried must stand for; a start and a closing orbit, for each period of 12 steps; a piece; a cycle of
 * the catalogue. Bytes of that; all rounds in units of the lines of constant angle: two rounds take 1.3, three 1.9. */
static const double SAMPLE_SECONDS = 0.03, START_SECONDS = 3e-7, SEED_SECONDS = 1.1e-5, PIECE_SECONDS = 2.5e-4,
                    CYCLE_SECONDS = 2.8e-4, CYCLE_BYTES = 2000, ALL_ROUNDS = 1.5;

typedef struct {
  double seconds; /* for each period */
  double cycles;
} effort;

/* Steps of a period, in units of those of weak drives. */
static double slowness(const kz_pendulum *pendulum) {
  kz_numerics fine;
  kz_numerics_fine(pendulum, &fine);
  return fine.steps_per_period / 96.0;
}

static effort sample(const kz_scene *scene, int64_t max_period, double *found) {
  kz_saddles_plan plan = scene->saddles;
  plan.max_period = max_period;
  const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, &plan, 1);
  const int64_t all = lines.count * lines.pieces, n = all < SAMPLE_PIECES ? all : SAMPLE_PIECES;
  const double share = (double)n / (double)all;
  effort sum = {0};
  for (int64_t i = 0; i < n; i++) {
    int64_t work[2];
    const int64_t cycles = kz_lines_search(&lines, (2 * i + 1) * all / (2 * n), SAMPLE_STARTS, found, work);
    sum.cycles += (double)cycles / (REPEATS * share);
    sum.seconds += slowness(lines.pendulum) / share * (START_SECONDS * (double)work[0] + SEED_SECONDS * (double)work[1]);
  }
  return sum;
}

/* Of all lines of constant angle. Periods are added until the effort shows how it grows. */
static effort estimate(const kz_scene *scene) {
  const int64_t longest = scene->saddles.max_period;
  double *found = kz_malloc(kz_piece_bytes(&scene->saddles));
  effort now = {0}, before = {0};
  int64_t period = 0;
  while (period < longest && now.seconds < SAMPLE_SECONDS) {
    before = now;
    now = sample(scene, ++period, found);
  }
  free(found);
  if (period == longest || before.seconds <= 0) return now;
  const double growth = pow(fmax(1, now.seconds / before.seconds), (double)(longest - period));
  return (effort){growth * now.seconds, growth * now.cycles};
}

kz_cost kz_saddles_cost(const kz_scene *scene) {
  const kz_saddles_plan *plan = &scene->saddles;
  const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, plan, 1);
  const effort all = estimate(scene);
  const double cycles = fmin(all.cycles, KZ_SADDLES_MOST), bytes = PIECES_OF_A_CYCLE * (double)kz_cycle_bytes(plan);
  return (kz_cost){
      .disk_bytes = 1e5 + cycles * bytes,
      .memory_bytes = PIECES_AT_ONCE * (double)kz_piece_bytes(plan),
      .first_bytes = cycles * (CYCLE_BYTES + bytes),
      .core_seconds = ALL_ROUNDS * ((double)plan->max_period * all.seconds +
                                    PIECE_SECONDS * slowness(lines.pendulum) * (double)(lines.count * lines.pieces)) +
                      CYCLE_SECONDS * cycles};
}
