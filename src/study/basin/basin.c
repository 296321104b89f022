/* Study `basin`: the attractors of a window, then a label for every cell.
 *
 * scene -> discovery -> trapping regions -> map table -> tiles of cells -> (cells that ended nowhere known feed another round) ->
 * ids, measures and chunks of the file, tile by tile. A window that is its own mirror image needs half the cells: cell f mirrors cell n - 1 - f. */
#include "basin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/accuracy.h"
#include "boundary.h"
#include "lifetime.h"
#include "resilience/resilience.h"
#include "numerics/step_check.h"
#include "phases.h"
#include "proof_write.h"
#include "shocks_write.h"

/* The errors of the numerics behind the labels, and warnings about them. */
static void measure_numerics(const kz_scene *scene, kz_dynamics *dynamics, kz_window_summary *labels, FILE *summary) {
  labels->step_error = kz_basin_warn_steps(scene, summary);
  labels->table_error = NAN;
  if (scene->basin.method != KZ_METHOD_ICM) return;
  labels->table_error = kz_dynamics_table_error(dynamics, kz_stencil(scene->basin.interpolation));
  kz_steps_warn_table(&scene->basin, labels->table_error, summary);
}

/* The sample from which the share of doubtful labels is estimated. */
typedef struct {
  int64_t n, *cell, *label; /* [n] */
  int32_t *followed;        /* [n, whole tiles], rank 0 */
} sample;

static kz_status take_sample(const kz_basin_plan *plan, const kz_run *run, kz_dynamics *dynamics, sample *s) {
  s->n = kz_doubt_cells(plan);
  s->cell = kz_malloc((size_t)s->n * sizeof *s->cell + 1);
  s->label = kz_calloc((size_t)s->n + 1, sizeof *s->label);
  s->followed = kz_rank(run->ranks) == 0 ? kz_malloc((size_t)(s->n + KZ_DOUBT_TILE) * sizeof *s->followed) : NULL;
  for (int64_t i = 0; i < s->n; i++) s->cell[i] = kz_doubt_cell(plan, i);
  return kz_doubt_follow(plan, run, dynamics, s->followed);
}

/* Writes everything but the cells. Rank 0. */
static kz_status write_facts(const kz_scene *scene, const kz_chunks *chunks, const sample *s, FILE *summary) {
  kz_dynamics *dynamics = chunks->labelling->dynamics;
  const bool table = scene->basin.method == KZ_METHOD_ICM;
  kz_window_summary labels = {.cells = chunks->labelling->tiles.cells,
                              .counts = chunks->counts,
                              .trapped_share = kz_dynamics_trapped_share(dynamics),
                              .doubt = table ? kz_doubt_count(&scene->basin, s->followed, s->label)
                                             : kz_doubt_of_all(chunks->counts.doubtful, kz_unique_cells(&scene->basin))};
  measure_numerics(scene, dynamics, &labels, summary);
  return kz_basin_write(scene, chunks->catalogue, &labels, chunks->store, summary);
}

kz_resilience_plan kz_shocks_asked(const kz_basin_plan *plan) {
  kz_resilience_plan asked = {.scale = plan->shocks.scale,
                              .farthest = 2 * kz_axis_fastest(&plan->velocity),
                              .n_sizes = plan->shocks.sizes.count,
                              .max_periods = plan->max_periods};
  memcpy(asked.size, plan->shocks.sizes.values, (size_t)asked.n_sizes * sizeof *asked.size);
  return asked;
}

/* How far the motions of the catalogue are from the edges of their basins. Collective. */
static kz_status find_shocks(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                             kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = &scene->basin;
  int64_t n;
  if (!plan->has_shocks) return KZ_OK;
  const kz_resilience_plan asked = kz_shocks_asked(plan);
  kz_resilience *point = kz_resilience_list(labelling->dynamics, catalogue, &n);
  kz_status status = kz_resilience_run(labelling->run, labelling->dynamics, &asked, n, point);
  if (status == KZ_OK && store) status = kz_shocks_write(&asked, catalogue, n, point, store, summary);
  free(point);
  return kz_ranks_agree(labelling->run->ranks, status);
}

static kz_status write_window(const kz_scene *scene, kz_window_labels *labelling, kz_proof *proof, kz_catalogue *catalogue,
                              sample *s, kz_transients *transients, kz_store *store, FILE *summary) {
  const kz_run *run = labelling->run;
  KZ_TRY(kz_label_window(labelling));
  kz_proof_sample proved_sample = {.starts = 0};
  if (proof) KZ_TRY(kz_prove_window(labelling, proof, &proved_sample));
  if (scene->basin.method == KZ_METHOD_ICM) KZ_TRY(take_sample(&scene->basin, run, labelling->dynamics, s));
  kz_catalogue_make(labelling->dynamics, labelling->reached, catalogue);
  KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_basin_declare(scene, &labelling->tiles, store) : KZ_OK));
  kz_chunks chunks = {.labelling = labelling,
                      .catalogue = catalogue,
                      .store = store,
                      .n_sample = s->n,
                      .sample = s->cell,
                      .sample_label = s->label,
                      .transients = transients};
  KZ_TRY(kz_cells_write(&chunks));
  KZ_TRY(kz_ranks_agree(run->ranks, store ? write_facts(scene, &chunks, s, summary) : KZ_OK));
  if (proof)
    KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_proof_write(proof, catalogue, labelling->tiles.cells, &chunks.counts,
                                                             &proved_sample, store, summary)
                                            : KZ_OK));
  KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_lifetime_write(&scene->basin, transients, store, summary) : KZ_OK));
  KZ_TRY(kz_boundary_find(scene, labelling, catalogue, store, summary));
  KZ_TRY(kz_phases_find(scene, labelling, catalogue, store, summary));
  return find_shocks(scene, labelling, catalogue, store, summary);
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = &scene->basin;
  kz_window_labels labelling = {.plan = plan,
                                .pendulum = &scene->parameters.pendulum,
                                .run = run,
                                .tiles = kz_tiles_of(scene, KZ_TILE_CELLS),
                                .batch = kz_tile_cells(scene, KZ_TILE_CELLS),
                                .search = kz_search_of_basin(plan)};
  kz_catalogue catalogue = {0};
  kz_proof *proof;
  sample s = {0};
  kz_transients transients;
  kz_transients_make(plan, &transients);
  labelling.dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, plan->max_period);
  kz_dynamics_set_release(labelling.dynamics, &scene->parameters.release);
  kz_status status = kz_ranks_agree(run->ranks, kz_proof_plan(scene, &proof));
  if (status == KZ_OK) {
    const kz_window motions = kz_motions_window(&plan->theta, &plan->velocity);
    labelling.search.max_velocity = kz_dynamics_max_velocity(labelling.dynamics, &motions);
    status = write_window(scene, &labelling, proof, &catalogue, &s, &transients, store, summary);
  }
  kz_dynamics_free(labelling.dynamics);
  kz_window_labels_free(&labelling);
  kz_proof_free(proof);
  kz_catalogue_free(&catalogue);
  kz_transients_free(&transients);
  free(s.cell);
  free(s.label);
  free(s.followed);
  return status;
}

/* Without damping areas are conserved and nothing attracts. */
static kz_status write_undamped(const kz_scene *scene, kz_store *store, FILE *summary) {
  const kz_tiles tiles = kz_tiles_of(scene, KZ_TILE_CELLS);
  const kz_window_summary labels = {
      .cells = tiles.cells, .counts = {.unsettled = tiles.cells}, .step_error = NAN, .table_error = NAN};
  fprintf(summary, "basin: without damping there are no attractors, so every cell is labelled -1.\n");
  KZ_TRY(kz_basin_declare(scene, &tiles, store));
  KZ_TRY(kz_chunks_write_unsettled(&scene->basin, &tiles, store));
  return kz_basin_write(scene, &(kz_catalogue){0}, &labels, store, summary);
}

static kz_status run_undamped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  return kz_ranks_agree(run->ranks, store ? write_undamped(scene, store, summary) : KZ_OK);
}

/* With basin.accuracy: the scene with what the program chose. */
static kz_status run_accurate(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_choice choice;
  kz_scene chosen = *scene;
  KZ_TRY(kz_accuracy_choose(scene, run, store, summary, &choice));
  kz_setting_apply(choice.setting, &chosen);
  KZ_TRY(run_damped(&chosen, run, store, summary));
  return kz_ranks_agree(run->ranks, store ? kz_accuracy_write(&choice, scene->basin.accuracy, store) : KZ_OK);
}

kz_status kz_basin_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta <= 0) return run_undamped(scene, run, store, summary);
  return (isnan(scene->basin.accuracy) ? run_damped : run_accurate)(scene, run, store, summary);
}
