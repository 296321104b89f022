/* Writes the results of a proof to the file and the summary. */
#include <math.h>
#include <stdlib.h>

#include "basin.h"

/* Columns of the attractors. */
static kz_status write_attractors(const kz_catalogue *catalogue, const kz_proof *proof, kz_store *store) {
  const int64_t n = catalogue->count, phases = kz_catalogue_longest(catalogue);
  KZ_FREED int8_t *proved = kz_calloc((size_t)n + 1, sizeof *proved);
  KZ_FREED double *theta = kz_nan_filled(n * phases), *velocity = kz_nan_filled(n * phases), *multiplier = kz_nan_filled(2 * n);
  for (int64_t i = 0; i < n; i++) {
    const kz_entry *e = &catalogue->entries[i];
    if (e->row.period == 0) continue;
    const kz_proof_cycle cycle = {.period = e->row.period,
                                  .theta = e->theta,
                                  .velocity = e->velocity,
                                  .multiplier_re = e->row.multiplier_re,
                                  .multiplier_im = e->row.multiplier_im};
    proved[i] = kz_proof_confine(proof, &cycle, theta + i * phases, velocity + i * phases, multiplier + 2 * i);
  }
  KZ_TRY(kz_store_variable(store, "attractors", "proved", proved));
  KZ_TRY(kz_store_variable(store, "attractors", "strobe_theta_half_width", theta));
  KZ_TRY(kz_store_variable(store, "attractors", "strobe_velocity_half_width", velocity));
  return kz_store_variable(store, "attractors", "multiplier_half_width", multiplier);
}

static void print_labels(const kz_counts *counts, int64_t cells, FILE *summary) {
  fprintf(summary,
          "%.6g %% of the labels are proved, those of %lld cells in sums of two doubles, of %lld in sums of three. %lld "
          "labels are not proved.\n",
          100 * (double)counts->proved / (double)cells, (long long)counts->proved_in_pairs,
          (long long)counts->proved_in_triples, (long long)(cells - counts->proved));
  if (counts->refuted > 0)
    fprintf(summary,
            "warning: the proof gives %lld cells another label than the method did; their labels are replaced. The numerics "
            "are too "
            "coarse, or basin.max_periods is too small.\n",
            (long long)counts->refuted);
}

static void print_sample(const kz_proof_sample *sample, FILE *summary) {
  if (sample->starts == 0)
    fprintf(summary, "No attractor is proved, so no label is.\n");
  else
    fprintf(
        summary,
        "Of %lld random real starts of the window %lld are not proved. So at most %.2g of the window's area ends on another "
        "attractor than the proved ones (%.0f %% confidence).\n",
        (long long)sample->starts, (long long)sample->unproved, sample->high, 100 * KZ_PROOF_CONFIDENCE);
}

kz_status kz_proof_write(const kz_proof *proof, const kz_catalogue *catalogue, int64_t cells, const kz_counts *counts,
                         const kz_proof_sample *sample, kz_store *store, FILE *summary) {
  const double share = (double)counts->proved / (double)cells;
  print_labels(counts, cells, summary);
  print_sample(sample, summary);
  KZ_TRY(kz_store_real(store, "basin", "proved_share", share));
  KZ_TRY(kz_store_integer(store, "basin", "refuted", counts->refuted));
  KZ_TRY(kz_store_real(store, "basin", "other_share_high", sample->high));
  KZ_TRY(kz_store_real(store, "basin", "other_share_confidence", KZ_PROOF_CONFIDENCE));
  KZ_TRY(kz_store_integer(store, "basin", "other_share_starts", sample->starts));
  return write_attractors(catalogue, proof, store);
}
