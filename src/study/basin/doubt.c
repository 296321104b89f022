#include "doubt.h"

#include "cells/cell_starts.h"
#include "numerics/cells.h"

enum { SAMPLE = 7300, TILE = 256 }; /* cells: a share of 5 % is known to +-0.5 points */

static const double MANY = 0.05; /* share of doubtful labels that is warned of */

/* Context of the stage: cell i of the sample follows from window, cells and seed alone; it is a unique cell. */
typedef struct {
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
} job;

static int64_t cell_of(const kz_basin_plan *plan, int64_t i) {
  return kz_shuffled(i, kz_unique_cells(plan), plan->seed);
}

/* Cells of the sample; 0 for all methods but icm, which consider all cells. */
static int64_t sample_size(const kz_basin_plan *plan) {
  const int64_t own = plan->method == KZ_METHOD_ICM ? kz_unique_cells(plan) : 0;
  return kz_smaller(own, SAMPLE);
}

static kz_status follow_cells(void *context, int64_t first, int64_t n, void *record) {
  const job *j = context;
  const kz_labeller labeller = kz_cell_labeller(j->plan, j->dynamics);
  int64_t cell[TILE];
  kz_label label[TILE];
  for (int64_t i = 0; i < n; i++) cell[i] = cell_of(j->plan, first + i);
  KZ_TRY(kz_label_first(&labeller, n, cell, label));
  for (int64_t i = 0; i < n; i++) ((int32_t *)record)[i] = label[i].label;
  return KZ_OK;
}

kz_doubt kz_doubt_of(const kz_basin_plan *plan, const kz_doubt_sample *sample, int64_t doubtful) {
  const int64_t all = kz_unique_cells(plan);
  int64_t differing = 0;
  if (plan->method != KZ_METHOD_ICM)
    return (kz_doubt){all, kz_share_of_part(doubtful, all, all), kz_share_of_part(0, all, all)};
  doubtful = 0;
  for (int64_t i = 0; i < sample->n; i++) {
    if (sample->followed[i] == KZ_DOUBTFUL)
      doubtful++;
    else
      differing += sample->followed[i] != sample->label[i];
  }
  return (kz_doubt){sample->n, kz_share_of_part(doubtful, sample->n, all), kz_share_of_part(differing, sample->n, all)};
}

kz_status kz_doubt_follow(const kz_basin_plan *plan, const kz_run *run, kz_dynamics *dynamics,
                          kz_doubt_sample *sample) {
  job j = {plan, dynamics};
  const int64_t n = sample->n = sample_size(plan);
  kz_stage stage = kz_stage_of_items("doubt", n, TILE, TILE * sizeof(int32_t), follow_cells, &j);
  stage.everywhere = false;
  if (n == 0) return KZ_OK;
  sample->cell = kz_malloc((size_t)n * sizeof *sample->cell);
  sample->label = kz_calloc((size_t)n, sizeof *sample->label);
  sample->followed = kz_rank(run->ranks) == 0 ? kz_malloc((size_t)stage.n_tiles * stage.record_bytes) : NULL;
  for (int64_t i = 0; i < n; i++) sample->cell[i] = cell_of(plan, i);
  return kz_stage_run(run, &stage, sample->followed);
}

void kz_doubt_free(kz_doubt_sample *sample) {
  free(sample->cell);
  free(sample->label);
  free(sample->followed);
}

/* " (95 % interval: ..)" in percent; nothing for a share that was counted. */
static const char *interval_of(const kz_share *share, char text[64]) {
  text[0] = '\0';
  if (share->low < share->high)
    snprintf(text, 64, " (95 %% interval: %.3g to %.3g %%)", 100 * share->low, 100 * share->high);
  return text;
}

static void doubt_print(const kz_doubt *doubt, int32_t method, FILE *summary) {
  const kz_share *share = &doubt->doubtful, *other = &doubt->differing;
  char text[64];
  if (method == KZ_METHOD_EXACT) {
    fprintf(
        summary,
        "%.3g %% of the cells were doubtful at the first precision level and were followed again with more digits.\n",
        100 * share->share);
    return;
  }
  if (method == KZ_METHOD_DIRECT)
    fprintf(summary, "%.3g %% of the labels are doubtful (evidence 9): the error of the orbit may change them.\n",
            100 * share->share);
  if (method == KZ_METHOD_ICM)
    fprintf(summary,
            "%.3g %% of the labels are doubtful%s: the error of the orbit may change them. This is from %lld cells "
            "that were "
            "integrated.\n",
            100 * share->share, interval_of(share, text), (long long)doubt->cells);
  if (method == KZ_METHOD_ICM)
    fprintf(summary, "%.3g %% more%s differ from the label by integration.\n", 100 * other->share,
            interval_of(other, text));
  if (share->share > MANY)
    fprintf(summary,
            "warning: more than %g %% of the labels are doubtful; basin.method: exact decides nearly all of them\n",
            100 * MANY);
}

static kz_status write_share(const char *name, const kz_share *share, kz_store *store) {
  const double values[] = {share->share, share->low, share->high};
  const char *const ends[] = {"", "_low", "_high"};
  char attribute[32];
  for (int i = 0; i < 3; i++) {
    snprintf(attribute, sizeof attribute, "%s_share%s", name, ends[i]);
    KZ_TRY(kz_store_real(store, "basin", attribute, values[i]));
  }
  return KZ_OK;
}

kz_status kz_doubt_write(const kz_doubt *doubt, int32_t method, kz_store *store, FILE *summary) {
  if (doubt->cells == 0) return KZ_OK;
  doubt_print(doubt, method, summary);
  KZ_TRY(write_share("doubtful", &doubt->doubtful, store));
  return write_share("differing", &doubt->differing, store);
}
