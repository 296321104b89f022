#include "accuracy.h"

#include "numerics/cells.h"
#include "numerics/share.h"

/* Samples, in multiples of the fewest that can prove an accuracy: then some labels may be wrong. */
static const double MARGIN = 3;

/* Cells with reference labels for an accuracy. */
static int64_t samples_for(double accuracy) {
  const double n = MARGIN * (double)kz_share_sample(1 - accuracy);
  return (int64_t)fmax(1000, ceil(n));
}

enum { MOST = 32 }; /* candidates */

/* The candidates in ascending order of their cost on these cells. */
typedef struct {
  const kz_reference_labels *reference;
  const kz_setting *candidates[MOST];
  int64_t count, first;
} walk;

static void order_cells(const kz_reference_labels *reference, walk *w) {
  double cost[MOST];
  const double mean_periods = kz_reference_labels_sum(reference).mean_periods,
               cells = (double)kz_unique_cells(reference->plan);
  *w = (walk){.reference = reference};
  for (const kz_setting *s = kz_settings; s < kz_settings + kz_setting_count && w->count < MOST; s++) {
    if (!s->candidate) continue;
    const double own = kz_setting_cost(s, cells, mean_periods);
    int64_t place = w->count++;
    for (; place > 0 && cost[place - 1] > own; place--) {
      cost[place] = cost[place - 1];
      w->candidates[place] = w->candidates[place - 1];
    }
    cost[place] = own;
    w->candidates[place] = s;
  }
}

static kz_status try_config(void *context, int64_t tile, void *record) {
  const walk *w = context;
  return kz_setting_measure(w->candidates[w->first + tile], w->reference, 0, record);
}

/* Tries the settings from the cheapest on, two at a time; the first that meets the accuracy is chosen, else `exact`. */
static kz_status accuracy_choose(const kz_reference_labels *reference, const kz_run *run, double accuracy,
                                 kz_choice *choice) {
  walk w;
  const int64_t step = 2; /* equal for any number of ranks: kept stages come in one order */
  kz_setting_measured measured[2];
  order_cells(reference, &w);
  *choice = (kz_choice){.samples = reference->samples, .flipped = kz_reference_labels_sum(reference).flipped};
  for (w.first = 0; w.first < w.count && !choice->setting; w.first += step) {
    const int64_t left = w.count - w.first;
    const kz_stage stage = kz_stage_for_all("settings", kz_smaller(left, step), sizeof *measured, try_config, &w);
    KZ_TRY(kz_stage_run(run, &stage, measured));
    for (int64_t i = 0; i < stage.n_tiles && !choice->setting; i++) {
      choice->tried++;
      choice->wrong = measured[i].wrong;
      if (kz_share_of(measured[i].wrong, w.reference->samples).high <= 1 - accuracy)
        choice->setting = w.candidates[w.first + i];
    }
  }
  if (!choice->setting) choice->setting = kz_setting_exact;
  return KZ_OK;
}

static void accuracy_print(const kz_choice *choice, double accuracy, FILE *summary) {
  if (choice->setting == kz_setting_exact) {
    fprintf(
        summary,
        "accuracy %.10g: method exact is taken, which decides or flags every label. None of the %lld other settings is "
        "accurate "
        "enough on %lld sampled cells.\n",
        accuracy, (long long)choice->tried, (long long)choice->samples);
    return;
  }
  const kz_share wrong = kz_share_of(choice->wrong, choice->samples),
                 flips = kz_share_of(choice->flipped, choice->samples);
  fprintf(summary,
          "accuracy %.10g: %s is the cheapest of %lld settings that is accurate enough: %lld of %lld sampled cells are "
          "wrong, at "
          "most %.3f %% of all (95 %%). Rounding of the start alone changes %.3f %%.\n",
          accuracy, choice->setting->label, (long long)choice->tried, (long long)choice->wrong,
          (long long)choice->samples, 100 * wrong.high, 100 * flips.share);
}

kz_status kz_accuracy_choose(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary,
                             kz_choice *choice) {
  const double accuracy = scene->basin->accuracy;
  KZ_AUTOFREE_BY(kz_reference_labels_free) kz_reference_labels reference = {0};
  KZ_AUTOFREE char *path = kz_reference_path(store);
  KZ_TRY(kz_reference_labels_make(scene, run, samples_for(accuracy), path, &reference));
  KZ_TRY(accuracy_choose(&reference, run, accuracy, choice));
  KZ_TRY(kz_ranks_agree(run->ranks, path ? kz_reference_labels_save(&reference, path) : KZ_OK));
  if (summary) accuracy_print(choice, accuracy, summary);
  return KZ_OK;
}

kz_status kz_accuracy_write(const kz_choice *choice, double accuracy, kz_store *store) {
  const kz_share wrong = kz_share_of(choice->wrong, choice->samples);
  KZ_TRY(kz_store_real(store, "basin", "accuracy", accuracy));
  KZ_TRY(kz_store_text(store, "basin", "setting", choice->setting->label));
  if (choice->setting == kz_setting_exact) return KZ_OK;
  KZ_TRY(kz_store_integer(store, "basin", "samples", choice->samples));
  KZ_TRY(kz_store_real(store, "basin", "wrong", wrong.share));
  KZ_TRY(kz_store_real(store, "basin", "wrong_low", wrong.low));
  KZ_TRY(kz_store_real(store, "basin", "wrong_high", wrong.high));
  return kz_store_real(store, "basin", "floor", kz_share_of(choice->flipped, choice->samples).share);
}
