/* How long the transients of a window last. */
#include "basin.h"

enum {
  CELLS = 1 << 18, /* Number of cells that are looked at, about */
  ENOUGH = 30      /* fewer ends give no mean */
};

/* Rows that are not mirror images. */
static int64_t own_rows(const kz_basin_plan *plan) {
  return (kz_unique_cells(plan) + plan->theta.count - 1) / plan->theta.count;
}

kz_transients kz_transients_make(const kz_basin_plan *plan) {
  return (kz_transients){.time = kz_malloc((size_t)(CELLS + 2 * plan->theta.count) * sizeof(uint32_t))};
}

int64_t kz_transients_pick(const kz_basin_plan *plan, int64_t first, int64_t n, const int16_t *label,
                           const uint32_t *periods, void *picked) {
  const int64_t columns = plan->theta.count, own = own_rows(plan), step = 1 + columns * own / CELLS;
  int64_t count = 0;
  for (int64_t f = first, end; f < first + n && f / columns < own; f = end) {
    const int64_t next_row = (f / columns + 1) * columns;
    end = next_row < first + n ? next_row : first + n;
    for (int64_t i = f - first; i < end - first && f / columns % step == 0; i++) {
      const uint32_t time = label[i] < 0 ? KZ_NOT_ENDED : periods[i];
      memcpy((char *)picked + KZ_TRANSIENT_BYTES * count++, &time, sizeof time);
    }
  }
  return count;
}

void kz_transients_add(kz_transients *transients, int64_t n, const void *picked) {
  memcpy(transients->time + transients->n, picked, (size_t)n * KZ_TRANSIENT_BYTES);
  transients->n += n;
}

/* The note for cases where motions have not settled. */
static void lifetime_print(const kz_lifetime *life, int64_t max_periods, FILE *summary) {
  if (life->open == 0) return;
  if (life->ended >= ENOUGH)
    fprintf(summary,
            "Transients: a motion that has not settled after %.0f periods takes %.4g more on average (95 %% interval: "
            "%.4g to "
            "%.4g).",
            life->from, life->mean, life->low, life->high);
  else
    fprintf(
        summary,
        "Transients: %lld motions have not settled and %lld have, so their mean time is at least %.3g periods (95 %%).",
        (long long)life->open, (long long)life->ended, life->low);
  if (life->mean < (double)max_periods / 5)
    fprintf(summary, " The %lld that have not settled are more than this mean explains: they may never settle.",
            (long long)life->open);
  else
    fprintf(summary, " The %lld that have not settled may be chaotic transients: try a larger basin.max_periods.",
            (long long)life->open);
  fprintf(summary, "\n");
}

kz_status kz_lifetime_write(const kz_basin_plan *plan, kz_transients *t, kz_store *store, FILE *summary) {
  const kz_lifetime life = kz_lifetime_tail(t->n, t->time, (double)plan->max_periods);
  lifetime_print(&life, plan->max_periods, summary);
  KZ_TRY(kz_store_real(store, "basin", "lifetime", life.mean));
  KZ_TRY(kz_store_real(store, "basin", "lifetime_low", life.low));
  KZ_TRY(kz_store_real(store, "basin", "lifetime_high", life.high));
  return kz_store_real(store, "basin", "lifetime_after", life.from);
}
