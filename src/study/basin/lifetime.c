/* How long the transients of a window last. */
#include <math.h>
#include <stdlib.h>

#include "boundary.h"
#include "numerics/cells.h"

enum {
  CELLS = 1 << 18, /* that are looked at, about */
  BLOCK = 1 << 14, /* cells read at once, or a row */
  ENOUGH = 30      /* ends that make a mean worth telling */
};

/* The settling times of every step-th row of those that are not mirror images: how many, and how many cells are open. */
static kz_status read_times(const kz_basin_plan *plan, kz_store *store, double *time, int64_t *n, int64_t *n_open) {
  const int64_t columns = plan->theta.count, own = (kz_unique_cells(plan) + columns - 1) / columns;
  const int64_t step = 1 + columns * own / CELLS,
                several = BLOCK / columns / step * step; /* rows of a block; 0: one row is enough */
  const int64_t rows = several > 0 ? several : 1, stride = several > 0 ? several : step;
  int16_t *label = kz_malloc((size_t)(rows * columns) * sizeof *label);
  uint32_t *periods = kz_malloc((size_t)(rows * columns) * sizeof *periods);
  kz_status status = KZ_OK;
  for (int64_t row = 0; status == KZ_OK && row < own; row += stride) {
    const int64_t here = own - row < rows ? own - row : rows;
    status = kz_store_rows(store, "basin", "attractor", row, here, label);
    if (status == KZ_OK) status = kz_store_rows(store, "basin", "settling_time", row, here, periods);
    for (int64_t i = 0; status == KZ_OK && i < here * columns; i++) {
      if (i / columns % step != 0) continue;
      *n_open += label[i] < 0;
      if (label[i] >= 0) time[(*n)++] = periods[i];
    }
  }
  free(label);
  free(periods);
  return status;
}

/* In words, where motions are still open. */
static void print(const kz_lifetime *life, int64_t max_periods, FILE *summary) {
  if (life->open == 0) return;
  if (life->ended >= ENOUGH)
    fprintf(summary,
            "Transients: a motion that has not settled after %.0f periods takes %.4g more on average (95 %% interval: %.4g to "
            "%.4g).",
            life->from, life->mean, life->low, life->high);
  else
    fprintf(summary,
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

kz_status kz_lifetime_write(const kz_scene *scene, kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = &scene->basin;
  const int64_t columns = plan->theta.count;
  int64_t n = 0, n_open = 0;
  double *time = kz_malloc((size_t)(CELLS + 2 * columns) * sizeof *time);
  kz_status status = read_times(plan, store, time, &n, &n_open);
  if (status == KZ_OK) {
    const kz_lifetime life = kz_lifetime_tail(n, time, n_open, (double)plan->max_periods);
    print(&life, plan->max_periods, summary);
    status = kz_store_real(store, "basin", "lifetime", life.mean);
    if (status == KZ_OK) status = kz_store_real(store, "basin", "lifetime_low", life.low);
    if (status == KZ_OK) status = kz_store_real(store, "basin", "lifetime_high", life.high);
    if (status == KZ_OK) status = kz_store_real(store, "basin", "lifetime_after", life.from);
  }
  free(time);
  return status;
}
