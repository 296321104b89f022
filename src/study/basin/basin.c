/* Study `basin`: the attractors of a window, then a label for every cell.
 *
 * scene -> discovery -> trapping regions -> map table -> tiles of cells -> (cells that ended nowhere known feed another
 * round) -> ids, measures and chunks of the file, tile by tile. A window that is its own mirror image needs half the
 * cells: cell f mirrors cell n - 1 - f. */
#include "accuracy/accuracy.h"
#include "basin.h"
#include "cells/scene_search.h"
#include "numerics/resolve.h"
#include "kapitza/dynamics_steps.h"

/* ---- parts of other folders ---- */

static const kz_basin_part *wanted_part(const kz_scene *scene, int study) {
  return kz_study_is_wanted(kz_studies[study], scene) ? kz_studies[study]->of_basin : NULL;
}

static double parts_bytes(const kz_scene *scene) {
  double bytes = 0;
  for (int i = 0; i < kz_study_count; i++)
    if (wanted_part(scene, i) && wanted_part(scene, i)->bytes) bytes += wanted_part(scene, i)->bytes(scene);
  return bytes;
}

static kz_status make_parts(const kz_scene *scene, kz_window_labels *labelling) {
  labelling->parts = kz_calloc((size_t)kz_study_count, sizeof *labelling->parts);
  for (int i = 0; i < kz_study_count; i++) {
    if (!wanted_part(scene, i)) continue;
    kz_part *p = labelling->parts + labelling->n_parts++;
    p->part = wanted_part(scene, i);
    p->own = (void *)scene;
    if (p->part->make) KZ_TRY(p->part->make(scene, &p->own));
  }
  return KZ_OK;
}

static void free_parts(kz_window_labels *labelling) {
  for (const kz_part *p = labelling->parts; p < labelling->parts + labelling->n_parts; p++)
    if (p->part->free) p->part->free(p->own);
  free(labelling->parts);
}

/* Disk space of FILE and checkpoint, from Fig. 12 with 10^6 to 4 10^8 cells: finer grids have longer equal runs. */
static double packed_bytes(double cells) {
  return 0.9 * pow(cells, 0.96);
}

kz_cost kz_basin_cost(const kz_scene *scene) {
  const kz_basin_plan *plan = scene->basin;
  const kz_tiles tiles = kz_tiles_of(scene, KZ_TILE_CELLS);
  const int64_t cells = plan->theta.count * plan->velocity.count;
  const double nodes = plan->method == KZ_METHOD_ICM ? (double)plan->table_theta * (double)plan->table_velocity : 0;
  const double regions = pow((double)kz_regions_cells(cells), 2);
  return (kz_cost){
      .cells = cells,
      .disk_bytes = 3e5 + 40 * (double)plan->starts + 8.2 * nodes + packed_bytes((double)cells),
      .memory_bytes = 14 * nodes + 100 * regions + parts_bytes(scene) + 40 * (double)kz_tile_capacity(&tiles),
      .rank0_bytes = 4e6,
      .shared_bytes = 0.2 * (double)cells};
}

static void print_numerics(const kz_scene *scene, FILE *summary) {
  const kz_numerics *numerics = &scene->numerics;
  const kz_scheme scheme = kz_scheme_at(numerics->scheme);
  fprintf(summary, "Integrator: %s%s, %d steps per drive period", scheme.name,
          kz_is_processed(numerics->scheme) ? " splitting" : "", (int)numerics->steps_per_period);
  if (kz_is_processed(scene->asked.scheme) && !kz_is_processed(numerics->scheme) && isnan(scene->basin->accuracy))
    fprintf(summary, " (processed does not reach numerics.tolerance = %g for this pendulum)", scene->asked.tolerance);
  else if (!kz_is_processed(numerics->scheme) && numerics->steps_per_period != scheme.default_steps)
    fprintf(summary, " (its default is %d)", (int)scheme.default_steps);
}

/* Prints the steps of a basin and their error, and a warning for each class of speeds whose error exceeds
 * kz_steps_tolerance. Returns an upper estimate of the largest error of a drive period, rad. */
static double warn_steps(const kz_scene *scene, FILE *summary) {
  const kz_step_motions motions = kz_motions_of_basin(scene);
  const kz_speed_errors classes = kz_motions_errors(&motions);
  const double worst = kz_worst_error(&classes);
  print_numerics(scene, summary);
  fprintf(summary, " (error per period <= %.2g rad, %.2g of a cell).\n", worst, worst / motions.cell);
  kz_motions_warn(&motions, &classes, summary);
  return worst;
}

/* The errors of the numerics behind the labels, and warnings about them. */
static void measure_numerics(const kz_scene *scene, kz_dynamics *dynamics, kz_window_summary *labels, FILE *summary) {
  labels->step_error = warn_steps(scene, summary);
  labels->table_error = NAN;
  if (scene->basin->method != KZ_METHOD_ICM) return;
  labels->table_error = kz_dynamics_table_error(dynamics, kz_stencil(scene->basin->interpolation));
  kz_steps_warn_table(scene->basin, labels->table_error, summary);
}

/* Advice about undecided cells. */
static const char *advice_of(const kz_window_labels *labelling) {
  for (const kz_part *p = labelling->parts; p < labelling->parts + labelling->n_parts; p++)
    if (p->part->advice) return p->part->advice(p->own);
  return "their orbits need more than quad precision.";
}

/* Writes everything that follows from the labels of the cells. Rank 0. */
static kz_status write_results(const kz_scene *scene, const kz_chunks *chunks, FILE *summary) {
  kz_dynamics *dynamics = chunks->labelling->dynamics;
  kz_window_summary labels = {.cells = chunks->labelling->tiles.cells,
                              .counts = chunks->counts,
                              .trapped_share = kz_dynamics_trapped_share(dynamics),
                              .advice = advice_of(chunks->labelling),
                              .doubt = kz_doubt_of(scene->basin, chunks->sample, chunks->counts.doubtful)};
  measure_numerics(scene, dynamics, &labels, summary);
  KZ_TRY(kz_basin_write(scene, chunks->catalogue, &labels, chunks->store, summary));
  for (const kz_part *p = chunks->labelling->parts; p < chunks->labelling->parts + chunks->labelling->n_parts; p++)
    if (p->part->write) KZ_TRY(p->part->write(p->own, chunks, summary));
  return kz_lifetime_write(scene->basin, chunks->transients, chunks->store, summary);
}

/* A window at work. */
typedef struct {
  kz_window_labels labels;
  kz_catalogue catalogue;
  kz_doubt_sample sample;
  kz_transients transients;
} window;

static void free_window(window *w) {
  kz_dynamics_free(w->labels.dynamics);
  kz_window_labels_free(&w->labels);
  free_parts(&w->labels);
  kz_catalogue_free(&w->catalogue);
  kz_doubt_free(&w->sample);
  free(w->transients.time);
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = scene->basin;
  const kz_window motions = kz_motions_window(&plan->theta, &plan->velocity);
  KZ_AUTOFREE_BY(free_window)
  window w = {.labels = {.plan = plan,
                         .parameters = &scene->parameters,
                         .run = run,
                         .tiles = kz_tiles_of(scene, KZ_TILE_CELLS),
                         .tile = kz_tile_cells(scene, KZ_TILE_CELLS),
                         .search = kz_search_of_basin(plan)},
              .transients = kz_transients_make(plan)};
  kz_window_labels *labels = &w.labels;
  kz_chunks chunks = {labels, &w.catalogue, store, .sample = &w.sample, .transients = &w.transients};
  labels->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, plan->max_period);
  kz_studies_begin(scene, &scene->parameters.pendulum, NULL, labels->dynamics);
  KZ_TRY(kz_ranks_agree(run->ranks, make_parts(scene, labels)));
  labels->search.max_velocity = kz_dynamics_max_velocity(labels->dynamics, &motions);
  KZ_TRY(kz_label_window(labels));
  for (const kz_part *p = labels->parts; p < labels->parts + labels->n_parts; p++)
    if (p->part->follow) KZ_TRY(p->part->follow(p->own, labels));
  KZ_TRY(kz_doubt_follow(plan, run, labels->dynamics, &w.sample));
  kz_catalogue_make(labels->dynamics, labels->reached, &w.catalogue);
  KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_basin_declare(scene, &labels->tiles, store) : KZ_OK));
  KZ_TRY(kz_cells_write(&chunks));
  KZ_TRY(kz_ranks_agree(run->ranks, store ? write_results(scene, &chunks, summary) : KZ_OK));
  for (const kz_part *p = labels->parts; p < labels->parts + labels->n_parts; p++)
    if (p->part->find) KZ_TRY(p->part->find(p->own, &chunks, store, summary));
  return KZ_OK;
}

/* Packs all tiles of a window in which no cell settles. Rank 0. */
static kz_status pack_unsettled(kz_window_labels *l) {
  kz_status status = KZ_OK;
  KZ_AUTOFREE void *record = kz_malloc(kz_tile_labels_bytes(l));
  for (int64_t i = 0; i < kz_tile_capacity(&l->tiles); i++) l->cell[i].periods = l->plan->max_periods;
  for (int64_t tile = 0; tile < l->tiles.own && status == KZ_OK; tile++) {
    status = kz_tile_labels_pack(l, tile, record);
    kz_local_records_add(&l->records, tile, record, *(uint64_t *)record);
  }
  return status;
}

/* Without damping areas are conserved and nothing attracts. */
static kz_status write_undamped(const kz_scene *scene, kz_chunks *chunks, FILE *summary) {
  kz_window_labels *l = chunks->labelling;
  kz_store *store = chunks->store;
  KZ_TRY(kz_ranks_agree(l->run->ranks, store ? pack_unsettled(l) : KZ_OK));
  KZ_TRY(kz_ranks_agree(l->run->ranks, store ? kz_basin_declare(scene, &l->tiles, store) : KZ_OK));
  KZ_TRY(kz_cells_write(chunks));
  const kz_window_summary labels = {
      .cells = l->tiles.cells, .counts = chunks->counts, .step_error = NAN, .table_error = NAN};
  if (summary) fprintf(summary, "basin: without damping there are no attractors, so every cell is labelled -1.\n");
  return kz_ranks_agree(l->run->ranks,
                        store ? kz_basin_write(scene, chunks->catalogue, &labels, store, summary) : KZ_OK);
}

static kz_status run_undamped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_window_labels labelling = {.plan = scene->basin, .run = run, .tiles = kz_tiles_of(scene, KZ_TILE_CELLS)};
  kz_catalogue none = {0};
  kz_chunks chunks = {&labelling, &none, store};
  labelling.cell = kz_calloc((size_t)kz_tile_capacity(&labelling.tiles), sizeof *labelling.cell);
  const kz_status status = write_undamped(scene, &chunks, summary);
  kz_window_labels_free(&labelling);
  return status;
}

/* With basin.accuracy: the scene with what the program chose. */
static kz_status run_accurate(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_choice choice;
  kz_scene chosen = *scene;
  KZ_TRY(kz_accuracy_choose(scene, run, store, summary, &choice));
  kz_plans_copy(&chosen);
  kz_setting_apply(choice.setting, &chosen);
  const kz_status status = run_damped(&chosen, run, store, summary);
  kz_plans_free(&chosen);
  KZ_TRY(status);
  return kz_ranks_agree(run->ranks, store ? kz_accuracy_write(&choice, scene->basin->accuracy, store) : KZ_OK);
}

kz_status kz_basin_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta <= 0) return run_undamped(scene, run, store, summary);
  return (isnan(scene->basin->accuracy) ? run_damped : run_accurate)(scene, run, store, summary);
}

/* Without damping nothing is labelled. What basin.accuracy chooses is compared with reference labels. */
kz_status kz_basin_check(const kz_scene *scene) {
  const kz_step_motions motions = kz_motions_of_basin(scene);
  kz_numerics reference;
  if (!(motions.pendulum.beta > 0)) return KZ_OK;
  if (isnan(scene->basin->accuracy)) return kz_motions_check(&motions);
  return kz_reference_labels_numerics(scene->basin, &motions.pendulum, &reference);
}
