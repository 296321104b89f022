/* Common parts of the measures of a sweep. */
#include "sweep.h"

bool kz_sweep_measures(const kz_sweep_plan *plan, int64_t measure) {
  for (int64_t i = 0; i < plan->measure.count; i++)
    if (plan->measure.values[i] == measure) return true;
  return false;
}

bool kz_sweep_has_grid(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  bool wanted = kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS);
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(plan, true, &i)); i++) wanted = wanted || part->on_grid;
  return scene->has_basin && wanted;
}

kz_status kz_sweep_stage(const kz_run *run, const kz_stage *stage, kz_records_fn write, kz_store *store,
                         FILE *summary) {
  KZ_AUTOFREE void *records = kz_malloc((size_t)stage->n_tiles * stage->record_bytes);
  KZ_TRY(kz_stage_run(run, stage, records));
  return kz_ranks_agree(run->ranks, store ? write(stage->context, records, store, summary) : KZ_OK);
}

bool kz_words_repeat(const kz_integers *words) {
  for (int64_t i = 1; i < words->count; i++)
    for (int64_t j = 0; j < i; j++)
      if (words->values[i] == words->values[j]) return true;
  return false;
}

#define BARRED(code, word, run) "|" word
const char *kz_sweep_measure_words(void) {
  static const char words[] = KZ_SWEEP_MEASURES(BARRED);
  return words + 1;
}

const char *kz_sweep_lack(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  const bool plane = kz_sweep_is_plane(plan), branches = kz_sweep_part_next(plan, true, &(int){0});
  if (kz_words_repeat(&plan->measure)) return "measure: has a word twice; name each measure once";
  for (int64_t i = 0; plane && i < plan->measure.count; i++)
    if (branches || (plan->measure.values[i] >= 0 && plan->measure.values[i] < KZ_SWEEP_OWN))
      return "measure: has a word that goes along one key; give parameter, min, max and count instead of x and y, or "
             "words "
             "that "
             "go over a plane";
  return NULL;
}
