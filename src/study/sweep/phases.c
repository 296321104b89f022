/* Measure `phases` of a sweep: how much of the cells or starts ends alike at whatever phase of the drive it is released, at each value. */
#include "labelling/phases.h"

#include <math.h>
#include <stdlib.h>

#include "numerics/cells.h"
#include "sweep.h"
#include "basin/plan.h"

/* Items with a common end; a cell of a folded grid counts for its mirror image too. */
static int64_t count_alike(const kz_phases *p, int64_t total) {
  int64_t alike = 0;
  for (int64_t i = 0; i < p->n; i++)
    if (kz_phases_common(p, i) > 0) alike += total - 1 - i < p->n ? 1 : 2;
  return alike;
}

kz_status kz_sweep_phases(const kz_scene *scene, const kz_run *run, kz_dynamics *dynamics, const kz_release *release,
                          int64_t n_cells, int64_t max_periods, int64_t *alike) {
  const kz_sweep_plan *plan = scene->sweep;
  const int64_t n = n_cells > 0 ? n_cells : plan->starts;
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  KZ_FREED double *start = kz_malloc(2 * (size_t)n * sizeof *start);
  for (int64_t i = 0; i < n_cells; i++) kz_cell_start(scene->basin, i, start + 2 * i);
  if (n_cells == 0) kz_dynamics_starts(&window, plan->seed, n, start); /* half-turns */
  for (int64_t i = n_cells; i < n; i++) start[2 * i] *= M_PI;
  kz_phases p = {.labeller = kz_pair_labeller(start, max_periods, KZ_BY_STATES, dynamics),
                 .release = *release,
                 .phases = plan->phases,
                 .n = n,
                 .stage = "sweep phases"};
  p.labeller.at_strobe = false;
  const kz_status status = kz_phases_label(&p, run);
  if (status == KZ_OK && p.label)
    *alike = count_alike(&p, n_cells > 0 ? scene->basin->theta.count * scene->basin->velocity.count : n);
  free(p.label);
  KZ_TRY(status);
  return kz_ranks_broadcast(run->ranks, alike, sizeof *alike);
}
