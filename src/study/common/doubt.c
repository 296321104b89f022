#include "doubt.h"

#include <math.h>
#include <stdlib.h>

#include "cells.h"

enum {
  SAMPLE = 7300, /* +-0.5 points at 5 % */
  TILE = 256     /* cells */
};

static const double MANY = 0.05; /* share of doubtful labels that is warned of */

typedef struct {
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
  int64_t n, of; /* cells of the sample, and of those that are labelled */
} sample;

static int64_t cell_of(const sample *s, int64_t i) {
  return kz_shuffled(i, s->of, s->plan->seed);
}

int64_t kz_doubt_cells(const kz_basin_plan *plan) {
  const int64_t own = kz_own_cells(plan);
  return own < SAMPLE ? own : SAMPLE;
}

static kz_status follow_tile(void *context, int64_t tile, void *record) {
  const sample *s = context;
  int32_t *label = record;
  double state[2 * TILE];
  int64_t periods[TILE];
  const int64_t first = tile * TILE, n = s->n - first < TILE ? s->n - first : TILE;
  for (int64_t i = 0; i < n; i++) kz_cell_state(s->plan, cell_of(s, first + i), state + 2 * i);
  kz_dynamics_follow(s->dynamics, KZ_FOLLOW_ERRORS, n, s->plan->max_periods, state, label, periods);
  return KZ_OK;
}

static void count(const sample *s, const int32_t *followed, const int16_t *label, kz_doubt *doubt) {
  int64_t doubtful = 0, differing = 0;
  for (int64_t i = 0; i < s->n; i++) {
    if (followed[i] == KZ_DOUBTFUL)
      doubtful++;
    else
      differing += followed[i] != label[cell_of(s, i)];
  }
  *doubt = (kz_doubt){s->n, kz_share_of_part(doubtful, s->n, s->of), kz_share_of_part(differing, s->n, s->of)};
}

kz_status kz_doubt_measure(const kz_basin_plan *plan, kz_ranks *ranks, kz_dynamics *dynamics, const int16_t *label,
                           kz_doubt *doubt) {
  sample s = {.plan = plan, .dynamics = dynamics, .n = kz_doubt_cells(plan), .of = kz_own_cells(plan)};
  kz_stage stage = {.name = "doubt",
                    .n_tiles = (s.n + TILE - 1) / TILE,
                    .record_bytes = TILE * sizeof(int32_t),
                    .work = follow_tile,
                    .context = &s,
                    .keep = true};
  int32_t *followed = NULL;
  kz_status status = KZ_OK;
  if (kz_ranks_own(ranks) == 0 && !(followed = malloc((size_t)stage.n_tiles * stage.record_bytes)))
    status = kz_fail(KZ_FAILED, "no memory for %lld cells", (long long)s.n);
  status = kz_ranks_agree(ranks, status);
  if (status == KZ_OK) status = kz_stage_run(ranks, &stage, followed);
  if (status == KZ_OK && followed) count(&s, followed, label, doubt);
  free(followed);
  return status;
}

static void tell(const kz_doubt *doubt, bool with_table, FILE *summary) {
  const kz_share *share = &doubt->doubtful, *other = &doubt->differing;
  fprintf(
      summary,
      "%.3g %% of the labels are doubtful (95 %%: %.3g to %.3g %%): steps and rounding may change them; %lld cells integrated "
      "again\n",
      100 * share->share, 100 * share->low, 100 * share->high, (long long)doubt->cells);
  if (with_table)
    fprintf(summary, "%.3g %% more (95 %%: %.3g to %.3g %%) are labelled otherwise than by integration\n", 100 * other->share,
            100 * other->low, 100 * other->high);
  if (share->share > MANY)
    fprintf(
        summary,
        "warning: more than %g %% of the labels are doubtful; more numerics.steps_per_period may decide some of them, rounding "
        "stays\n",
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

kz_status kz_doubt_write(const kz_doubt *doubt, bool with_table, kz_store *store, FILE *summary) {
  if (doubt->cells == 0) return KZ_OK;
  tell(doubt, with_table, summary);
  KZ_TRY(write_share("doubtful", &doubt->doubtful, store));
  return write_share("differing", &doubt->differing, store);
}
