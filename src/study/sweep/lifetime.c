/* Measure `lifetime` of a sweep: how long the motions take at each value that have not settled soon. */
#include <math.h>
#include <stdlib.h>

#include "numerics/cells.h"
#include "sweep.h"

enum { TILE = 256 };

typedef struct {
  kz_dynamics *dynamics;
  const double *start; /* [starts][2] */
  int64_t starts, max_periods;
} following;

/* Periods until each start of a tile is trapped; -1 = it is not. */
static kz_status lifetime_tile(void *context, int64_t tile, void *record) {
  const following *f = context;
  double *time = record, state[2 * TILE];
  int32_t label[TILE];
  int64_t periods[TILE];
  const int64_t first = tile * TILE, n = f->starts - first < TILE ? f->starts - first : TILE;
  for (int64_t i = 0; i < 2 * n; i++) state[i] = f->start[2 * first + i];
  kz_dynamics_follow(f->dynamics, KZ_FOLLOW_DIRECT, n, f->max_periods, state, label, periods);
  for (int64_t i = 0; i < n; i++) time[i] = label[i] > 0 ? (double)periods[i] : -1;
  return KZ_OK;
}

kz_status kz_sweep_lifetime(const kz_sweep_plan *plan, const kz_run *run, kz_dynamics *dynamics, int64_t max_periods,
                            kz_lifetime *life) {
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  double *start = kz_malloc(2 * (size_t)plan->starts * sizeof *start);
  following f = {dynamics, start, plan->starts, max_periods};
  const kz_stage stage = {.name = "sweep lifetimes",
                          .n_tiles = (plan->starts + TILE - 1) / TILE,
                          .record_bytes = TILE * sizeof(double),
                          .work = lifetime_tile,
                          .context = &f,
                          .keep = true,
                          .everywhere = true};
  double *time = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_dynamics_starts(&window, plan->seed, plan->starts, start);
  const kz_status status = kz_stage_run(run, &stage, time);
  int64_t n = 0, n_open = 0;
  for (int64_t i = 0; status == KZ_OK && i < plan->starts; i++) {
    n_open += time[i] < 0;
    if (time[i] >= 0) time[n++] = time[i];
  }
  if (status == KZ_OK) *life = kz_lifetime_tail(n, time, n_open, (double)max_periods);
  free(start);
  free(time);
  return status;
}

kz_status kz_sweep_lifetime_write(const kz_sweep_plan *plan, const kz_sweep_catalogue *catalogue, kz_store *store) {
#define COLUMN(name, field) \
  KZ_COLUMN(store, "sweep", name, plan->values.count, double, catalogue[i].samples > 0 ? catalogue[i].lifetime.field : NAN)
  COLUMN("lifetime", mean);
  COLUMN("lifetime_low", low);
  COLUMN("lifetime_high", high);
  COLUMN("lifetime_after", from);
  COLUMN("lifetime_open", open);
  return KZ_OK;
}
