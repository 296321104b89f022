/* Study `attractors`: the catalogue of a window of starts, without a grid. */
#include <stdlib.h>

#include "catalogue.h"
#include "numerics/cells.h"
#include "search.h"
#include "numerics/step_check.h"

typedef struct {
  const kz_attractors_plan *plan;
  kz_dynamics *dynamics;
  double *state;    /* [starts][2] */
  int32_t *label;   /* [starts] */
  int64_t *reached; /* [numbers from 1] */
  int64_t max_periods;
} finding;

kz_cost kz_attractors_cost(const kz_scene *scene) {
  return (kz_cost){.disk_bytes = 1e5, .memory_bytes = 100 * (double)scene->attractors.starts};
}

static kz_motions motions_of_starts(const kz_scene *scene) {
  return kz_motions_of(scene, kz_axis_fastest(&scene->attractors.velocity), "numerics.steps_per_period|attractors.velocity");
}

kz_status kz_attractors_check(const kz_scene *scene) {
  const kz_motions motions = motions_of_starts(scene);
  return motions.pendulum.beta > 0 ? kz_motions_check(&motions) : KZ_OK;
}

static void attractors_allocate(const kz_scene *scene, finding *s) {
  size_t n = (size_t)scene->attractors.starts;
  s->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, scene->attractors.max_period);
  s->state = kz_malloc(2 * n * sizeof *s->state);
  s->label = kz_malloc(n * sizeof *s->label);
}

static kz_search search_of(const finding *s) {
  kz_search search = kz_search_of_attractors(s->plan, s->max_periods);
  search.max_velocity = kz_dynamics_max_velocity(s->dynamics, &search.window);
  return search;
}

static kz_status attractors_discover(const kz_run *run, finding *s) {
  const kz_search search = search_of(s);
  KZ_TRY(kz_search_window(run, s->dynamics, &search, s->state, s->label));
  s->reached = kz_calloc((size_t)kz_dynamics_count(s->dynamics) + 1, sizeof *s->reached);
  for (int64_t i = 0; i < s->plan->starts; i++) s->reached[s->label[i]]++;
  return KZ_OK;
}

static kz_status publish(const kz_scene *scene, const finding *s, kz_store *store, FILE *summary) {
  kz_catalogue catalogue = {0};
  const kz_motions motions = motions_of_starts(scene);
  const kz_speed_errors classes = kz_motions_errors(&motions);
  kz_motions_warn(&motions, &classes, summary);
  kz_catalogue_make(s->dynamics, s->reached, &catalogue);
  const kz_status status = kz_catalogue_write(&catalogue, &scene->parameters.pendulum, false, store);
  if (status == KZ_OK) {
    kz_catalogue_print(&catalogue, false, summary);
    fprintf(summary, "%lld of %lld starts did not settle within %lld drive periods.\n", (long long)s->reached[0],
            (long long)s->plan->starts, (long long)s->max_periods);
  }
  kz_catalogue_free(&catalogue);
  return status;
}

/* Without damping areas are conserved and nothing attracts. */
static kz_status run_undamped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (kz_rank(run->ranks) != 0) return KZ_OK;
  fprintf(summary, "attractors: without damping there are no attractors.\n");
  return kz_catalogue_write(&(kz_catalogue){0}, &scene->parameters.pendulum, false, store);
}

static finding begin(const kz_scene *scene) {
  finding s = {.plan = &scene->attractors, .max_periods = kz_settling_periods(scene->parameters.pendulum.beta)};
  attractors_allocate(scene, &s);
  return s;
}

static void end(finding *s) {
  kz_dynamics_free(s->dynamics);
  free(s->state);
  free(s->label);
  free(s->reached);
}

kz_status kz_attractors_measure(const kz_scene *scene, double *seconds) {
  double state[2 * KZ_SEARCH_FEW];
  int32_t label[KZ_SEARCH_FEW];
  int64_t n;
  if (!(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  finding s = begin(scene);
  const kz_search search = search_of(&s);
  const kz_status status = kz_search_measure(s.dynamics, &search, state, label, &n, seconds);
  end(&s);
  return status;
}

kz_status kz_attractors_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta <= 0) return run_undamped(scene, run, store, summary);
  finding s = begin(scene);
  kz_status status = kz_ranks_agree(run->ranks, attractors_discover(run, &s));
  if (status == KZ_OK && kz_rank(run->ranks) == 0) status = publish(scene, &s, store, summary);
  end(&s);
  return status;
}
