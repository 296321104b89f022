/* Study `saddles`: rounds of ever closer lines of starts, across each other, until one finds nothing new and the index sums are 0. */
#include "saddles.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
  ROUNDS = 8,       /* at most */
  USUAL_ROUNDS = 3, /* of most searches */
  QUIET = 2         /* rounds without a new cycle, after which the search ends even if the sums are not 0 */
};
/* Everything about the cycles that were found. Rank 0. */
static void list_cycles(const kz_scene *scene, const kz_found *found, kz_cycle_list *cycles, kz_index_sums *sums) {
  const int64_t max_period = scene->saddles->max_period;
  KZ_FREED_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, max_period);
  kz_cycle_list_free(cycles);
  kz_index_sums_free(sums);
  kz_dynamics_add_cycles(dynamics, max_period, found->count, found->cycle);
  kz_cycle_list_make(dynamics, cycles);
  kz_index_sums_make(cycles, max_period, sums);
}

static void free_found(kz_found *found) {
  free(found->cycle);
}

/* Rounds until enough is known; without damping the sums say nothing. Collective. */
static kz_status run_rounds(const kz_scene *scene, const kz_run *run, kz_found *found, kz_cycle_list *cycles,
                            kz_index_sums *sums) {
  const bool here = kz_rank(run->ranks) == 0, undamped = scene->parameters.pendulum.beta <= 0;
  int32_t enough = 0;
  for (int round = 0, quiet = 0; round < ROUNDS && !enough; round++) {
    char name[32];
    snprintf(name, sizeof name, "saddles %d", round + 1);
    const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, scene->saddles, round);
    const int64_t before = found->count;
    KZ_TRY(kz_lines_run(run, &lines, name, found));
    quiet = round > 0 && found->count == before ? quiet + 1 : 0;
    const bool sampled =
        kz_sampling_stands_for(run) > 1; /* such a round always finds something new: most searches end after this one */
    const bool last = round == ROUNDS - 1 || (sampled && round + 1 == USUAL_ROUNDS);
    if (here && (quiet == 1 || (last && quiet == 0))) list_cycles(scene, found, cycles, sums);
    enough = last || quiet == QUIET || (quiet > 0 && (undamped || sums->open == 0));
    KZ_TRY(kz_ranks_broadcast(run->ranks, &enough, sizeof enough));
  }
  return KZ_OK;
}

kz_status kz_saddles_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_FREED_BY(free_found) kz_found found = {0};
  KZ_FREED_BY(kz_cycle_list_free) kz_cycle_list cycles = {0};
  KZ_FREED_BY(kz_index_sums_free) kz_index_sums sums = {0};
  KZ_TRY(run_rounds(scene, run, &found, &cycles, &sums));
  if (kz_rank(run->ranks) != 0) return KZ_OK;
  kz_saddles_print(scene, &cycles, &sums, summary);
  return kz_saddles_write(&cycles, &sums, store);
}

/* Messages and records of pieces that a rank holds; pieces in which a cycle is found; the least that a piece takes in the checkpoint. */
enum { PIECES_AT_ONCE = 5, PIECES_OF_A_CYCLE = 8, PAGE_BYTES = 4096 };
/* Bytes of a cycle of the catalogue. */
static const double CYCLE_BYTES = 2000;

double kz_saddles_expected(const kz_scene *scene) {
  const double growth = 1 + 3 * kz_stiffness(&scene->parameters.pendulum);
  return fmin(2 * pow(growth, (double)scene->saddles->max_period), KZ_SADDLES_MOST);
}

kz_cost kz_saddles_cost(const kz_scene *scene) {
  const kz_saddles_plan *plan = scene->saddles;
  const double cycles = kz_saddles_expected(scene), bytes = PIECES_OF_A_CYCLE * (double)kz_cycle_bytes(plan);
  double pieces = 0;
  for (int round = 0; round < USUAL_ROUNDS; round++) {
    const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, plan, round);
    pieces += (double)(lines.count * lines.pieces);
  }
  return (kz_cost){.disk_bytes = 1e5 + PAGE_BYTES * pieces + cycles * bytes,
                   .memory_bytes = PIECES_AT_ONCE * (double)kz_piece_bytes(plan),
                   .rank0_bytes = cycles * (CYCLE_BYTES + bytes)};
}
