/* Measures that a sweep names: its own words, then those of its parts in the order of kz_studies. */
#include "sweep/plan.h"

static int64_t count_words(const char *words) {
  int64_t n = 1;
  for (; (words = strchr(words, '|')); words++) n++;
  return n;
}

kz_integers kz_sweep_part_words(const kz_sweep_plan *plan, const kz_sweep_part *part, bool of_branches) {
  kz_integers found = {0};
  int64_t first = KZ_SWEEP_OWN;
  for (int i = 0; i < kz_study_count && kz_studies[i]->of_sweep != part; i++)
    if (kz_studies[i]->of_sweep) first += count_words(kz_studies[i]->of_sweep->words);
  const int64_t n = count_words(part->words);
  for (int64_t i = 0; i < plan->measure.count; i++) {
    const int64_t word = plan->measure.values[i] - first;
    if (word >= 0 && word < n && (word < part->of_branches) == of_branches) found.values[found.count++] = word;
  }
  return found;
}

const kz_sweep_part *kz_sweep_part_next(const kz_sweep_plan *plan, bool of_branches, int *i) {
  for (; *i < kz_study_count; ++*i) {
    const kz_sweep_part *part = kz_studies[*i]->of_sweep;
    if (part && kz_sweep_part_words(plan, part, of_branches).count > 0) return part;
  }
  return NULL;
}

bool kz_sweep_has_points(const kz_sweep_plan *plan) {
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(plan, false, &i)); i++)
    if (!part->own_steps) return true;
  return false;
}
