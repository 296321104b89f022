/* The table of measures as rows, and what follows from them. */
#include "measures.h"
#include "kapitza/study_keys.h"
#include "sweep/plan.h"

#define ROW(word, unit, shape, needs) {#word, unit, shape, needs, kz_measure_##word},
#define NUMBER(word, needs, unit, name) ROW(word, unit, KZ_PER_ATTRACTOR, needs)
#define INTERVAL(word, needs, unit, name) ROW(word, unit, KZ_PER_INTERVAL, needs)
#define SIZES(word, needs, unit, name) ROW(word, unit, KZ_PER_SIZE, needs)
#define PAIR(word, needs, unit, name) ROW(word, unit, KZ_PER_PAIR, needs)
#define PENDULUM(word, needs, unit, name) ROW(word, unit, KZ_PER_PENDULUM, needs)
const kz_measure kz_measures[] = {KZ_MEASURES(NUMBER, INTERVAL, SIZES, PAIR, PENDULUM)};

#define BARRED(word, ...) "|" #word
const char *kz_measure_words(void) {
  static const char words[] = KZ_MEASURES(BARRED, BARRED, BARRED, BARRED, BARRED);
  return words + 1;
}

int64_t kz_measure_length(const kz_measure *measure, const kz_measured *measured) {
  const int64_t n = measured->catalogue.count;
  const int64_t length[] = {[KZ_PER_ATTRACTOR] = n,
                            [KZ_PER_INTERVAL] = 3 * n,
                            [KZ_PER_SIZE] = n * measured->plan->options.sizes.count,
                            [KZ_PER_PAIR] = n * n,
                            [KZ_PER_PENDULUM] = 1};
  return length[measure->shape];
}

int32_t kz_measures_need(const kz_integers *names_measure) {
  int32_t needs = 0;
  for (int64_t i = 0; i < names_measure->count; i++) needs |= kz_measures[names_measure->values[i]].needs;
  return needs;
}

static bool rows_names(const kz_integers *list, kz_measure_fn measure) {
  for (int64_t i = 0; i < list->count; i++)
    if (kz_measures[list->values[i]].fill == measure) return true;
  return false;
}

const char *kz_measures_lack(const kz_integers *list, const kz_measure_options *options) {
  if (kz_words_repeat(list)) return "names: has a word twice; name each measure once";
  if (rows_names(list, kz_measure_weighted_share) && !options->has_weight)
    return "weight: is missing, which weighted_share needs; give a mapping of theta and theta_spread";
  if (rows_names(list, kz_measure_share_within) && options->within == KZ_UNSET_INTEGER)
    return "within: is missing, which share_within needs; give a number of drive periods";
  return kz_sizes_lack(&options->sizes);
}
