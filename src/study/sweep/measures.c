/* What the measures of a sweep share. */
#include "measures/measures.h"
#include "sweep.h"

bool kz_sweep_measures(const kz_sweep_plan *plan, int64_t measure) {
  for (int64_t i = 0; i < plan->measure.count; i++)
    if (plan->measure.values[i] == measure) return true;
  return false;
}

bool kz_sweep_has_grid(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  return scene->has_basin && (kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS) || kz_sweep_measures(plan, KZ_SWEEP_PHASES));
}

kz_status kz_sweep_stage(const kz_run *run, const kz_stage *stage, kz_records_fn write, kz_store *store, FILE *summary) {
  KZ_FREED void *records = kz_malloc((size_t)stage->n_tiles * stage->record_bytes);
  KZ_TRY(kz_stage_run(run, stage, records));
  return kz_ranks_agree(run->ranks, store ? write(stage->context, records, store, summary) : KZ_OK);
}

kz_integers kz_sweep_table_names(const kz_sweep_plan *plan) {
  kz_integers names = {0};
  for (int64_t i = 0; i < plan->measure.count; i++)
    if (plan->measure.values[i] >= KZ_SWEEP_TABLE) names.values[names.count++] = plan->measure.values[i] - KZ_SWEEP_TABLE;
  return names;
}

const char *kz_sweep_lack(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  const bool plane = kz_sweep_is_plane(plan);
  const kz_integers names = kz_sweep_table_names(plan);
  if (kz_words_repeat(&plan->measure)) return "measure: has a word twice; name each measure once";
  for (int64_t i = 0; i < plan->measure.count; i++) {
    const int64_t measure = plan->measure.values[i];
    if (plane && measure < KZ_SWEEP_ENDS)
      return "measure: attractors, basin_fractions, lifetime, resilience, phases, release_angle and "
             "strobe go along one key; give parameter, min, max and count instead of x and y";
    if (!plane && measure == KZ_SWEEP_ENDS)
      return "measure: ends is over a plane; give x and y instead of parameter, min, max and count";
  }
  if (kz_sweep_measures(plan, KZ_SWEEP_ENDS) && plan->ends.theta.count == 0)
    return "ends: is missing, which the measure ends needs; give a mapping of theta";
  for (int64_t i = 0; i < names.count; i++) {
    const kz_measure *measure = kz_measures + names.values[i];
    if (measure->shape == KZ_PER_PAIR) return "measure: intermingled_with is for one pendulum; name intermingledness";
    if (measure->shape == KZ_PER_SIZE && plan->options.sizes.count != 1)
      return "sizes: a sweep takes one size for harmless; leave the others out";
  }
  return kz_measures_lack(&names, &plan->options);
}
