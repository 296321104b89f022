/* The part `proof` of the study basin, and what it writes. */
#include "proof.h"

kz_status kz_proof_check(const kz_scene *scene) {
  kz_proof *proof;
  const kz_status status = kz_proof_begin(scene, &proof);
  kz_proof_free(proof);
  return status;
}

static void free_run(void *own) {
  kz_proof_work *run = own;
  for (int64_t i = 0; run->tile && i < run->tiles.own; i++) free(run->tile[i].marks);
  free(run->tile);
  kz_proof_free(run->proof);
  free(run);
}

static kz_status proof_make(const kz_scene *scene, void **own) {
  kz_proof_work *run = kz_calloc(1, sizeof *run);
  *own = run;
  return kz_proof_begin(scene, &run->proof);
}

/* Columns of the attractors. */
static kz_status write_attractors(const kz_catalogue *catalogue, const kz_proof *proof, kz_store *store) {
  const int64_t n = catalogue->count, phases = kz_catalogue_longest(catalogue);
  KZ_AUTOFREE int8_t *proved = kz_calloc((size_t)n + 1, sizeof *proved);
  KZ_AUTOFREE double *theta = kz_nan_filled(n * phases), *velocity = kz_nan_filled(n * phases),
                     *multiplier = kz_nan_filled(2 * n);
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

static int64_t proved_of(const kz_counts *counts) {
  return counts->evidence[KZ_PROVED] + counts->evidence[KZ_PROVED_IN_PAIRS] + counts->evidence[KZ_PROVED_IN_TRIPLES];
}

static void print_labels(const kz_counts *counts, int64_t cells, FILE *summary) {
  fprintf(
      summary,
      "%.6g %% of the labels are proved, those of %lld cells in sums of two doubles, of %lld in sums of three. %lld "
      "labels are not proved.\n",
      100 * (double)proved_of(counts) / (double)cells, (long long)counts->evidence[KZ_PROVED_IN_PAIRS],
      (long long)counts->evidence[KZ_PROVED_IN_TRIPLES], (long long)(cells - proved_of(counts)));
  if (counts->changed > 0)
    fprintf(summary,
            "warning: the proof gives %lld cells another label than the method did; their labels are replaced. The "
            "numerics "
            "are too "
            "coarse, or basin.max_periods is too small.\n",
            (long long)counts->changed);
}

static void print_sample(const kz_proof_sample *sample, FILE *summary) {
  if (sample->starts == 0)
    fprintf(summary, "No attractor is proved, so no label is.\n");
  else
    fprintf(summary,
            "Of %lld random real starts of the window %lld are not proved. So at most %.2g of the window's area ends "
            "on another "
            "attractor than the proved ones (%.0f %% confidence).\n",
            (long long)sample->starts, (long long)sample->unproved, sample->high, 100 * KZ_PROOF_CONFIDENCE);
}

static kz_status proof_write(void *own, const kz_chunks *chunks, FILE *summary) {
  const kz_proof_work *run = own;
  const kz_proof_sample *sample = &run->sample;
  const kz_counts *counts = &chunks->counts;
  const int64_t cells = run->tiles.cells;
  kz_store *store = chunks->store;
  const double share = (double)proved_of(counts) / (double)cells;
  print_labels(counts, cells, summary);
  print_sample(sample, summary);
  KZ_TRY(kz_store_real(store, "basin", "proved_share", share));
  KZ_TRY(kz_store_integer(store, "basin", "refuted", counts->changed));
  KZ_TRY(kz_store_real(store, "basin", "other_share_high", sample->high));
  KZ_TRY(kz_store_real(store, "basin", "other_share_confidence", KZ_PROOF_CONFIDENCE));
  KZ_TRY(kz_store_integer(store, "basin", "other_share_starts", sample->starts));
  return write_attractors(chunks->catalogue, run->proof, store);
}

static kz_status proof_follow(void *own, kz_window_labels *labelling) {
  return kz_prove_window(own, labelling);
}

static kz_status proof_take(void *own, int64_t tile, kz_label *cell) {
  return kz_proof_take(own, tile, cell);
}

const kz_basin_part kz_proof_part = {.bytes = kz_proof_bytes,
                                     .make = proof_make,
                                     .free = free_run,
                                     .follow = proof_follow,
                                     .take = proof_take,
                                     .write = proof_write};
