/* Study `measures`: the table of one pendulum. */
#include "measures.h"

#include "numerics/step_check.h"

static const char *const GROUP = "measures";

kz_cost kz_measures_cost(const kz_scene *scene) {
  const kz_measures_plan *plan = scene->measures;
  const int32_t needs = kz_measures_need(&plan->names);
  const double cells = needs & KZ_NEEDS_PICTURE ? (double)(plan->options.cells * plan->options.cells) : 0;
  const double starts = 2 * (double)plan->starts + cells;
  return (kz_cost){.cells = (int64_t)starts, .disk_bytes = 1e5 + 40 * starts, .memory_bytes = 100 * starts};
}

static kz_step_motions motions_of_starts(const kz_scene *scene) {
  return kz_motions_of(scene, kz_axis_fastest(&scene->measures->velocity),
                       "numerics.steps_per_period|measures.velocity");
}

kz_status kz_measures_check(const kz_scene *scene) {
  const kz_step_motions motions = motions_of_starts(scene);
  if (!(motions.pendulum.beta > 0))
    return kz_fail(KZ_REFUSED, "measures: needs damping, because without it there are no attractors; give damping");
  return kz_motions_check(&motions);
}

static kz_status write_attractors(const kz_measured *m, kz_store *store) {
  const kz_catalogue *list = &m->catalogue;
  const int64_t n = list->count;
  const kz_entry *e = list->entries;
  KZ_TRY(kz_store_dimension(store, GROUP, "attractor", n, NULL));
  KZ_TRY(kz_store_dimension(store, GROUP, "other", n, NULL));
  KZ_TRY(kz_store_dimension(store, GROUP, "size", m->plan->options.sizes.count, m->plan->options.sizes.values));
#define COLUMN(type, name, expression) KZ_COLUMN(store, GROUP, name, n, type, expression)
  COLUMN(const char *, "name", e[i].name);
  COLUMN(int32_t, "period", e[i].row.period);
  COLUMN(int32_t, "winding", e[i].row.winding);
  COLUMN(int8_t, "centre", e[i].row.centre);
  COLUMN(double, "theta", e[i].row.period > 0 ? e[i].theta[0] : kz_is_running(&e[i].row) ? NAN : e[i].row.mean);
  COLUMN(double, "velocity", e[i].row.period > 0 ? e[i].velocity[0] : e[i].row.mean_velocity);
  return KZ_OK;
}

/* The line of a measure in the summary, in SI if the scene is; `omega`: of the pivot, rad/s, else NaN. */
static void print_measure(const kz_measure *measure, int64_t n, const double *value, double omega, FILE *summary) {
  const char *unit = measure->unit + (strncmp(measure->unit, "1|", 2) == 0 ? 2 : 0), *own = unit;
  const double factor = kz_si_factor(omega, &unit);
  fprintf(summary, "  %-22s", measure->word);
  for (int64_t i = 0; i < n; i++) fprintf(summary, " %12.6g", value[i] * factor);
  fprintf(summary, "%s%s\n", unit == own ? "" : "  ", unit == own ? "" : unit);
}

/* A curve has at least the dimension 1, and a boundary in the plane at most 2. */
static void print_impossible_dimensions(int64_t n, const double *value, FILE *summary) {
  for (int64_t i = 0; i < n; i++)
    if (value[i] < 1 || value[i] > 2)
      fprintf(summary, "  boundary_dimension of %lld is outside of 1 to 2: starts were too few; give more cells\n",
              (long long)i);
}

/* The variables of one measure, and its line of the summary. */
static kz_status write_measure(const kz_measure *measure, const kz_measured *m, double omega, kz_store *store,
                               FILE *summary) {
  const int64_t n = m->catalogue.count, length = kz_measure_length(measure, m);
  KZ_AUTOFREE double *value = kz_malloc((size_t)length * sizeof *value + 1);
  measure->fill(m, value);
  if (measure->shape == KZ_PER_PAIR)
    fprintf(summary, "  %-22s for each pair, in the file\n", measure->word);
  else
    print_measure(measure, measure->shape == KZ_PER_INTERVAL ? n : length, value, omega, summary);
  if (measure->fill == kz_measure_boundary_dimension) print_impossible_dimensions(n, value, summary);
  if (measure->shape == KZ_PER_PENDULUM) return kz_store_real(store, GROUP, measure->word, value[0]);
  KZ_TRY(kz_store_variable(store, GROUP, measure->word, value));
  for (int end = 1; end <= 2 && measure->shape == KZ_PER_INTERVAL; end++) {
    char name[64];
    snprintf(name, sizeof name, "%s_%s", measure->word, end == 1 ? "low" : "high");
    KZ_TRY(kz_store_variable(store, GROUP, name, value + end * n));
  }
  return KZ_OK;
}

static kz_status measures_publish(const kz_measured *m, double omega, kz_store *store, FILE *summary) {
  const kz_integers *names = &m->plan->names;
  KZ_TRY(write_attractors(m, store));
  KZ_TRY(kz_store_integer(store, GROUP, "starts", m->plan->starts));
  KZ_TRY(kz_store_integer(store, GROUP, "cells", m->plan->options.cells));
  KZ_TRY(kz_store_real(store, GROUP, "shock_scale", m->plan->options.shock_scale));
  KZ_TRY(kz_store_real(store, GROUP, "shock_tolerance", m->plan->options.shock_tolerance));
  fprintf(summary, "measures of %lld attractors:\n", (long long)m->catalogue.count);
  for (int64_t id = 0; id < m->catalogue.count; id++)
    fprintf(summary, "  %lld: %s\n", (long long)id, m->catalogue.entries[id].name);
  for (int64_t i = 0; i < names->count; i++)
    KZ_TRY(write_measure(kz_measures + names->values[i], m, omega, store, summary));
  return KZ_OK;
}

kz_status kz_measures_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_measures_plan *plan = scene->measures;
  KZ_AUTOFREE_BY(kz_measured_free) kz_measured measured = {0};
  const kz_way way = plan->method == KZ_MEASURES_EXACT ? KZ_BY_LEVELS : KZ_BY_STATES;
  KZ_TRY(kz_measured_make(&scene->parameters.pendulum, &scene->numerics, plan, way, kz_measures_need(&plan->names), run,
                          &measured));
  return kz_ranks_agree(run->ranks,
                        store ? measures_publish(&measured, scene->parameters.pivot_frequency, store, summary) : KZ_OK);
}
