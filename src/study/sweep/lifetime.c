/* Measure `lifetime` of a sweep: how long the motions take at each value that have not settled soon. */
#include "numerics/cells.h"
#include "sweep.h"

enum { TILE = 256 };

typedef struct {
  kz_dynamics *dynamics;
  double *start; /* [starts][2] */
  int64_t starts, max_periods;
} following;

/* Periods until each start of a tile is trapped; -1 = it is not. */
static kz_status follow_starts(void *context, int64_t first, int64_t n, void *record) {
  const following *f = context;
  double *time = record;
  int32_t label[TILE];
  int64_t periods[TILE];
  kz_dynamics_follow(f->dynamics, KZ_FOLLOW_DIRECT, n, f->max_periods, f->start + 2 * first, label, periods);
  for (int64_t i = 0; i < n; i++) time[i] = label[i] > 0 ? (double)periods[i] : -1;
  return KZ_OK;
}

kz_status kz_sweep_lifetime(const kz_sweep_plan *plan, const kz_run *run, kz_dynamics *dynamics, int64_t max_periods,
                            kz_lifetime *life) {
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  KZ_FREED double *start = kz_malloc(2 * (size_t)plan->starts * sizeof *start);
  following f = {dynamics, start, plan->starts, max_periods};
  const kz_stage stage = kz_stage_of_items("sweep lifetimes", plan->starts, TILE, TILE * sizeof(double), follow_starts, &f);
  KZ_FREED double *time = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_dynamics_starts(&window, plan->seed, plan->starts, start);
  KZ_TRY(kz_stage_run(run, &stage, time));
  int64_t n = 0;
  for (int64_t i = 0; i < plan->starts; i++)
    if (time[i] >= 0) time[n++] = time[i];
  *life = kz_lifetime_tail(n, time, plan->starts - n, (double)max_periods);
  return KZ_OK;
}
