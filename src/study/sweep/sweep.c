/* Study `sweep`: quantities along one key of the pendulum mapping. */
#include "sweep.h"

#include <math.h>
#include <stdlib.h>

#include "numerics/settling.h"

#define BARRED(code, word, run) "|" word
const char *kz_sweep_measure_words(void) {
  static const char words[] = KZ_SWEEP_MEASURES(BARRED);
  return words + 1;
}

bool kz_sweep_measures(const kz_sweep_plan *plan, int64_t measure) {
  for (int64_t i = 0; i < plan->measure.count; i++)
    if (plan->measure.values[i] == measure) return true;
  return false;
}

bool kz_sweep_wanted(const kz_scene *scene) {
  return scene->has_sweep;
}

/* Rough seconds of one value, whose pendulum this is, on one core. */
static double value_seconds(const kz_scene *scene, const kz_pendulum *pendulum) {
  const kz_sweep_plan *plan = &scene->sweep;
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  const double period = 1e-9 * (double)scheme.kicks * scene->numerics.steps_per_period;
  const bool fractions = kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS);
  double seconds = 0;
  const bool resilience = kz_sweep_measures(plan, KZ_SWEEP_RESILIENCE);
  if (resilience) seconds += 5;
  if (fractions || resilience || kz_sweep_measures(plan, KZ_SWEEP_ATTRACTORS))
    seconds += kz_settling_search(pendulum, (double)plan->starts, period, kz_settling_periods(pendulum->beta)) + 0.1;
  if (fractions && scene->has_basin)
    seconds += (double)(scene->basin.table_theta * scene->basin.table_velocity) / 2 * period + 0.1 +
               7e-8 * kz_settling_cells(pendulum->beta, scene->basin.max_periods) *
                   (double)(scene->basin.theta.count * scene->basin.velocity.count);
  if (kz_sweep_measures(plan, KZ_SWEEP_RELEASE_ANGLE)) seconds += 0.3;
  if (kz_sweep_measures(plan, KZ_SWEEP_FLUTTER_RANGE)) seconds += 0.5;
  if (kz_sweep_measures(plan, KZ_SWEEP_STROBE)) seconds += 2 * 4 * period * (double)(plan->transient + plan->samples);
  return seconds;
}

static double all_seconds(const kz_scene *scene) {
  double seconds = 0;
  kz_pendulum pendulum;
  for (int64_t i = 0; i < scene->sweep.values.count; i++)
    if (kz_sweep_pendulum(scene, kz_sweep_value(&scene->sweep, i), &pendulum)) seconds += value_seconds(scene, &pendulum);
  return seconds;
}

kz_cost kz_sweep_cost(const kz_scene *scene) {
  const double values = (double)scene->sweep.values.count;
  const bool grid = kz_sweep_measures(&scene->sweep, KZ_SWEEP_BASIN_FRACTIONS) && scene->has_basin;
  const double nodes = grid ? (double)scene->basin.table_theta * (double)scene->basin.table_velocity : 0;
  const double cells = grid ? (double)scene->basin.theta.count * (double)scene->basin.velocity.count : 0;
  return (kz_cost){.cells = (int64_t)(cells * values),
                   .disk_bytes = values * (sizeof(kz_sweep_catalogue) + 1e3),
                   .memory_bytes = 3 * values * sizeof(kz_sweep_catalogue) + 100 * nodes + 2 * cells,
                   .core_seconds = all_seconds(scene)};
}

kz_status kz_sweep_stage(const kz_scene *scene, const kz_run *run, const kz_stage *stage, kz_records_fn write, kz_store *store,
                         FILE *summary) {
  kz_stage kept = *stage;
  kept.context = (void *)scene;
  kept.keep = true;
  void *records = kz_malloc((size_t)stage->n_tiles * stage->record_bytes);
  kz_status status = kz_stage_run(run, &kept, records);
  if (status == KZ_OK && kz_ranks_own(run->ranks) == 0) status = write(scene, records, store, summary);
  free(records);
  return kz_ranks_agree(run->ranks, status);
}

/* The catalogues and what joins them. */
static kz_status run_branches(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = &scene->sweep;
  bool wanted = false;
  for (int64_t measure = 0; measure <= KZ_SWEEP_RESILIENCE; measure++) wanted = wanted || kz_sweep_measures(plan, measure);
  if (!wanted) return KZ_OK;
  kz_sweep_branches branches = {0};
  kz_sweep_catalogue *catalogue = kz_malloc((size_t)plan->values.count * sizeof *catalogue);
  kz_status status = kz_sweep_catalogues(scene, run, catalogue);
  if (status == KZ_OK) status = kz_sweep_branches_make(scene, run, catalogue, &branches);
  if (status == KZ_OK && kz_ranks_own(run->ranks) == 0)
    status = kz_sweep_branches_write(scene, catalogue, &branches, store, summary);
  if (status == KZ_OK && kz_ranks_own(run->ranks) == 0 && kz_sweep_measures(plan, KZ_SWEEP_LIFETIME))
    status = kz_sweep_lifetime_write(plan, catalogue, store);
  kz_sweep_branches_free(&branches);
  free(catalogue);
  return kz_ranks_agree(run->ranks, status);
}

static kz_status write_values(const kz_scene *scene, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = &scene->sweep;
  const kz_sweep_parameter *parameter = kz_sweep_parameters + plan->parameter;
  double *values = kz_malloc((size_t)plan->values.count * sizeof *values);
  for (int64_t i = 0; i < plan->values.count; i++) values[i] = kz_sweep_value(plan, i);
  kz_status status = kz_store_text(store, "sweep", "parameter", parameter->name);
  if (status == KZ_OK) status = kz_store_text(store, "sweep", "parameter_units", parameter->unit);
  if (status == KZ_OK) status = kz_store_dimension(store, "sweep", "value", plan->values.count, values);
  free(values);
  KZ_TRY(status);
  fprintf(summary, "sweep of %s, %lld values from %.10g to %.10g\n", parameter->name, (long long)plan->values.count,
          plan->values.min, plan->values.max);
  kz_sweep_warn_steps(scene, summary);
  return KZ_OK;
}

kz_status kz_sweep_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  typedef kz_status (*run_fn)(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
#define RUN(code, word, procedure) procedure,
  static const run_fn runs[] = {KZ_SWEEP_MEASURES(RUN)};
  KZ_TRY(kz_ranks_agree(run->ranks, kz_ranks_own(run->ranks) == 0 ? write_values(scene, store, summary) : KZ_OK));
  KZ_TRY(run_branches(scene, run, store, summary));
  for (int64_t i = 0; i < (int64_t)(sizeof runs / sizeof runs[0]); i++)
    if (runs[i] && kz_sweep_measures(&scene->sweep, i)) KZ_TRY(runs[i](scene, run, store, summary));
  return KZ_OK;
}
