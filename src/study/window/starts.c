#include "window.h"

#include "numerics/cells.h"

/* Places of the cells of an axis. */
static __float128 *starts_places(const kz_axis *axis, const kz_view *view, int i) {
  __float128 *place = kz_malloc((size_t)axis->count * sizeof *place);
  for (int64_t cell = 0; cell < axis->count; cell++)
    place[cell] = view->offset[i] + view->scale[i] * kz_axis_share(axis, cell);
  return place;
}

void kz_window_starts_make(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_dynamics *dynamics,
                           kz_images *images, kz_window_starts *starts) {
  kz_view view;
  *starts =
      (kz_window_starts){.plan = plan, .pendulum = pendulum, .dynamics = dynamics, .images = kz_images_hold(images)};
  if (!images) {
    kz_cell_starts_make(plan, &starts->cells);
    return;
  }
  kz_images_serve(images, dynamics, pendulum, &plan->theta, &plan->velocity, &view);
  kz_hand_overs_make(images, view.reach, starts->hand_over);
  starts->place[0] = starts_places(&plan->theta, &view, 0);
  starts->place[1] = starts_places(&plan->velocity, &view, 1);
}

void kz_window_starts_free(kz_window_starts *starts) {
  kz_images_free(starts->images);
  free(starts->place[0]);
  free(starts->place[1]);
  kz_cell_starts_free(&starts->cells);
  *starts = (kz_window_starts){0};
}

/* A kz_start_fn. */
static kz_status start_cell(void *context, int64_t cell, kz_precision level, kz_start *start) {
  const kz_window_starts *s = context;
  const int64_t column = cell % s->plan->theta.count, row = cell / s->plan->theta.count;
  if (!s->images) return kz_cell_starts_at((void *)&s->cells, cell, level, start);
  kz_hand_over_start(&s->hand_over[level], s->place[0][column], s->place[1][row], start);
  start->from = kz_axis_centre(&s->plan->theta, column);
  return KZ_OK;
}

/* Level of kz_added_levels for cells as items. */
static kz_status decide_cells(void *context, int32_t row, int64_t n, const int64_t *cell, kz_decision *decision) {
  const kz_window_starts *s = context;
  (void)row;
  for (int64_t i = 0; i < n; i++) {
    const kz_coordinate start[2] = {kz_axis_coordinate(&s->plan->theta, cell[i] % s->plan->theta.count),
                                    kz_axis_coordinate(&s->plan->velocity, cell[i] / s->plan->theta.count)};
    KZ_TRY(kz_own_orbit_decide(s->dynamics, s->pendulum, start, s->plan->max_periods, decision + i));
  }
  return KZ_OK;
}

kz_labeller kz_window_labeller(const kz_window_starts *starts, bool decide) {
  static const kz_added_levels own_orbits = {&kz_own_orbit_level, 1, decide_cells};
  return (kz_labeller){.dynamics = starts->dynamics,
                       .max_periods = starts->plan->max_periods,
                       .way = KZ_BY_LEVELS,
                       .open = KZ_OPEN_CANDIDATES,
                       .start = start_cell,
                       .added = decide ? &own_orbits : NULL,
                       .context = (void *)starts};
}
