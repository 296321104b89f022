/* What the measures of a sweep share. */
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
