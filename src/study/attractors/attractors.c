/* Study `attractors`: the catalogue of a window of starts, without a grid. */
#include "labelling/catalogue.h"
#include "cells/scene_search.h"
#include "numerics/cells.h"
#include "numerics/step_check.h"
#include "plan.h"

kz_cost kz_attractors_cost(const kz_scene *scene) {
  return (kz_cost){.disk_bytes = 1e5, .memory_bytes = 100 * (double)scene->attractors->starts};
}

static kz_step_motions motions_of_starts(const kz_scene *scene) {
  return kz_motions_of(scene, kz_axis_fastest(&scene->attractors->velocity),
                       "numerics.steps_per_period|attractors.velocity");
}

kz_status kz_attractors_check(const kz_scene *scene) {
  const kz_step_motions motions = motions_of_starts(scene);
  return motions.pendulum.beta > 0 ? kz_motions_check(&motions) : KZ_OK;
}

static kz_search search_of(const kz_scene *scene) {
  return kz_search_of_attractors(scene->attractors, kz_settling_periods(scene->parameters.pendulum.beta));
}

/* label [starts]: where they end. */
static kz_status attractors_publish(const kz_scene *scene, const kz_dynamics *dynamics, const int32_t *label,
                                    kz_store *store, FILE *summary) {
  const int64_t starts = scene->attractors->starts;
  KZ_AUTOFREE int64_t *reached = kz_calloc((size_t)kz_dynamics_count(dynamics) + 1, sizeof *reached);
  KZ_AUTOFREE_BY(kz_catalogue_free) kz_catalogue catalogue = {0};
  const kz_step_motions motions = motions_of_starts(scene);
  const kz_speed_errors classes = kz_motions_errors(&motions);
  for (int64_t i = 0; i < starts; i++) reached[label[i]]++;
  kz_motions_warn(&motions, &classes, summary);
  kz_catalogue_make(dynamics, reached, &catalogue);
  KZ_TRY(kz_catalogue_write(&catalogue, &scene->parameters.pendulum, false, store));
  kz_catalogue_print(&catalogue, &scene->parameters, false, summary);
  fprintf(summary, "%lld of %lld starts did not settle within ", (long long)reached[0], (long long)starts);
  kz_periods_print(search_of(scene).max_periods, scene->parameters.pivot_frequency, summary);
  fputs(".\n", summary);
  return KZ_OK;
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_search search = search_of(scene);
  KZ_AUTOFREE_BY(kz_dynamics_freed)
  kz_dynamics *dynamics =
      kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, scene->attractors->max_period);
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)search.starts * sizeof *label);
  KZ_TRY(kz_ranks_agree(run->ranks, kz_search_window(run, dynamics, &search, label)));
  return store ? attractors_publish(scene, dynamics, label, store, summary) : KZ_OK;
}

kz_status kz_attractors_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta > 0) return run_damped(scene, run, store, summary);
  if (!store) return KZ_OK;
  fprintf(summary, "attractors: without damping there are no attractors.\n"); /* areas are conserved */
  return kz_catalogue_write(&(kz_catalogue){0}, &scene->parameters.pendulum, false, store);
}
