/* Measure `phases` of a sweep: how much of the cells or starts ends alike at whatever phase of the drive it is released, at each value.
 * Phases are spread evenly over a period, from 0 on. */
#include <math.h>

#include "labelling/labeller.h"
#include "numerics/cells.h"
#include "sweep.h"

enum { TILE = 1024, NO_COMMON_END = 0 };

typedef struct {
  kz_dynamics *dynamics; /* releases at the phase at work */
  const double *start;   /* [n][2] rad, rad per drive radian */
  int64_t n, max_periods;
} releasing;

/* Label of each start of a tile at the phase. */
static kz_status release_tile(void *context, int64_t tile, void *record) {
  const releasing *r = context;
  const int64_t first = tile * TILE, n = r->n - first < TILE ? r->n - first : TILE;
  kz_start start[TILE];
  double state[2 * TILE];
  int64_t periods[TILE];
  for (int64_t i = 0; i < n; i++) start[i] = kz_start_at(r->start[2 * (first + i)], r->start[2 * (first + i) + 1]);
  kz_released_states(r->dynamics, n, start, state);
  kz_dynamics_follow(r->dynamics, KZ_FOLLOW_DIRECT, n, r->max_periods, state, record, periods);
  return KZ_OK;
}

/* common [n]: where a start ends at all of kz_sweep_plan's phases. */
static kz_status release_at_phases(const kz_sweep_plan *plan, const kz_run *run, const kz_release *release, releasing *r,
                                   int32_t *common) {
  const kz_stage stage = kz_stage_for_all("sweep phases", (r->n + TILE - 1) / TILE, TILE * sizeof *common, release_tile, r);
  KZ_FREED int32_t *label = kz_malloc((size_t)(r->n + TILE) * sizeof *label);
  kz_release turned = *release;
  for (int64_t phase = 0; phase < plan->phases; phase++) {
    turned.phase = 2 * M_PI * (double)phase / (double)plan->phases;
    kz_dynamics_set_release(r->dynamics, &turned);
    KZ_TRY(kz_stage_run(run, &stage, label));
    for (int64_t i = 0; i < r->n; i++) common[i] = phase == 0 || common[i] == label[i] ? label[i] : NO_COMMON_END;
  }
  kz_dynamics_set_release(r->dynamics, release);
  return KZ_OK;
}

/* Those with a common end; a cell of a folded grid counts for its mirror image too. */
static int64_t count_alike(const kz_scene *scene, int64_t n_cells, int64_t n, const int32_t *common) {
  const int64_t total = n_cells > 0 ? scene->basin.theta.count * scene->basin.velocity.count : n;
  int64_t alike = 0;
  for (int64_t i = 0; i < n; i++)
    if (common[i] != NO_COMMON_END) alike += total - 1 - i < n ? 1 : 2;
  return alike;
}

kz_status kz_sweep_phases(const kz_scene *scene, const kz_run *run, kz_dynamics *dynamics, const kz_release *release,
                          int64_t n_cells, int64_t max_periods, int64_t *alike) {
  const kz_sweep_plan *plan = &scene->sweep;
  const int64_t n = n_cells > 0 ? n_cells : plan->starts;
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  KZ_FREED double *start = kz_malloc(2 * (size_t)n * sizeof *start);
  KZ_FREED int32_t *common = kz_malloc((size_t)n * sizeof *common);
  releasing r = {dynamics, start, n, max_periods};
  for (int64_t i = 0; i < n_cells; i++) kz_cell_start(&scene->basin, i, start + 2 * i);
  if (n_cells == 0) kz_dynamics_starts(&window, plan->seed, n, start); /* half-turns */
  for (int64_t i = n_cells; i < n; i++) start[2 * i] *= M_PI;
  KZ_TRY(release_at_phases(plan, run, release, &r, common));
  *alike = count_alike(scene, n_cells, n, common);
  return KZ_OK;
}
