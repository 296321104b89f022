/* Cycles and attractors, as lists for the caller. */
#include "../library.h"
#include "kapitza/dynamics_cycles.h"
#include "kapitza/study_saddles.h"

/* ---- lists ---- */

size_t kz_library_cycles_bytes(const kz_catalogue *catalogue) {
  size_t bytes = sizeof(kapitza_cycles) + (size_t)catalogue->count * sizeof(kapitza_cycle);
  for (int64_t i = 0; i < catalogue->count; i++) bytes += 2 * (size_t)catalogue->entries[i].row.period * sizeof(double);
  return bytes;
}

static void put_cycle(const kz_entry *e, bool attract, double *points, kapitza_cycle *cycle) {
  const kz_attractor *row = &e->row;
  const size_t bytes = (size_t)row->period * sizeof(double);
  const bool unstable = !attract && hypot(row->multiplier_re[0], row->multiplier_im[0]) > 1;
  *cycle = (kapitza_cycle){.period = row->period,
                           .winding = row->winding,
                           .centre = row->centre,
                           .symmetric = row->symmetric,
                           .mirror = e->mirror,
                           .mean_theta = row->mean,
                           .mean_velocity = row->mean_velocity,
                           .amplitude = row->amplitude,
                           .multiplier_re = {row->multiplier_re[0], row->multiplier_re[1]},
                           .multiplier_im = {row->multiplier_im[0], row->multiplier_im[1]},
                           .lyapunov = row->lyapunov,
                           .lyapunov_error = row->lyapunov_error,
                           .theta = points,
                           .velocity = points + row->period};
  snprintf(cycle->name, sizeof cycle->name, "%s%.50s", unstable ? "unstable " : "", e->name);
  memcpy(points, e->theta, bytes);
  memcpy(points + row->period, e->velocity, bytes);
}

void kz_library_cycles_put(const kz_catalogue *catalogue, bool attract, void *place) {
  kapitza_cycles *list = place;
  kapitza_cycle *cycle = (kapitza_cycle *)(list + 1);
  double *points = (double *)(cycle + catalogue->count);
  *list = (kapitza_cycles){catalogue->count, cycle};
  for (int64_t i = 0; i < catalogue->count; points += 2 * catalogue->entries[i++].row.period)
    put_cycle(catalogue->entries + i, attract, points, cycle + i);
}

kapitza_cycles *kz_library_cycles(const kz_catalogue *catalogue, bool attract) {
  void *place = kz_border_give(kz_library_cycles_bytes(catalogue));
  kz_library_cycles_put(catalogue, attract, place);
  return place;
}

/* ---- attractors ---- */

static kz_status work_attractors(kapitza_pendulum *p, void *context) {
  const kz_live_catalogue *catalogue;
  KZ_TRY(kz_engine_catalogue(p->engine, &p->scene, &catalogue));
  *(kapitza_cycles **)context = kz_library_cycles(&catalogue->list, true);
  return KZ_OK;
}

kapitza_status kapitza_attractors(kapitza_pendulum *pendulum, kapitza_cycles **list) {
  *list = NULL;
  return kz_library_call(pendulum, work_attractors, list);
}

/* ---- all cycles ---- */

typedef struct {
  int64_t period; /* largest, or that of one cycle */
  const double *window;
  double theta, velocity, distance;
  kapitza_cycles **list;
  int64_t *open;
} cycles_job;

static kz_status work_all(kapitza_pendulum *p, void *context) {
  enum { MOST = 32 };
  const cycles_job *j = context;
  const double *w = j->window;
  if (j->period < 1 || j->period > MOST || !(w[0] < w[1]) || !(w[2] < w[3]))
    return kz_fail(KZ_REFUSED, "cycles: max_period must be from 1 to %d, and a window have its least values first",
                   MOST);
  kz_scene scene = p->scene;
  kz_plans_copy(&scene);
  kz_numerics_resolve(&scene);
  const kz_window window = {w[0], w[1], w[2], w[3]};
  KZ_AUTOFREE_BY(kz_saddles_free) kz_catalogue all = {0};
  const kz_status status = kz_saddles_all(&scene, j->period, &window, &all, j->open);
  kz_plans_free(&scene);
  if (status == KZ_OK) *j->list = kz_library_cycles(&all, false);
  return status;
}

kapitza_status kapitza_all_cycles(kapitza_pendulum *pendulum, int64_t max_period, const double window[4],
                                  kapitza_cycles **list, int64_t *open) {
  cycles_job job = {.period = max_period, .window = window, .list = list, .open = open};
  *list = NULL;
  return kz_library_call(pendulum, work_all, &job);
}

/* ---- one cycle ---- */

/* Whether the mirror image of the first point is a point of the cycle. */
static int32_t is_symmetric(const kz_pendulum *pendulum, const kz_entry *e) {
  static const double SAME = 1e-7; /* rad */
  for (int32_t i = 0; kz_is_mirrored(pendulum) && i < e->row.period; i++)
    if (hypot(remainder(e->theta[i] + e->theta[0], 2 * M_PI), e->velocity[i] + e->velocity[0]) < SAME) return 1;
  return 0;
}

static kz_status work_near(kapitza_pendulum *p, void *context) {
  enum { MOST = 64 };
  const cycles_job *j = context;
  const kz_pendulum *pendulum = &p->scene.parameters.pendulum;
  if (j->period < 1 || j->period > MOST) return kz_fail(KZ_REFUSED, "a cycle has a period from 1 to %d", MOST);
  double theta[MOST] = {j->theta}, velocity[MOST] = {j->velocity};
  kz_numerics numerics;
  kz_entry entry = {.theta = theta, .velocity = velocity};
  kz_numerics_fine(pendulum, &numerics);
  kz_dynamics_close_cycle(pendulum, &numerics, j->period, j->distance, theta, velocity, &entry.row);
  kz_attractor *row = &entry.row;
  if (row->period > 0) {
    row->symmetric = is_symmetric(pendulum, &entry);
    row->lyapunov = log(hypot(row->multiplier_re[0], row->multiplier_im[0])) / row->period;
    row->lyapunov_error = 0;
    kz_orbit_name(row->period, row->winding, row->centre, entry.name);
  }
  *j->list = kz_library_cycles(&(kz_catalogue){.count = row->period > 0, .entries = &entry}, false);
  return KZ_OK;
}

kapitza_status kapitza_cycle_near(kapitza_pendulum *pendulum, int64_t period, double theta, double velocity,
                                  double distance, kapitza_cycles **list) {
  cycles_job job = {.period = period, .theta = theta, .velocity = velocity, .distance = distance, .list = list};
  *list = NULL;
  return kz_library_call(pendulum, work_near, &job);
}
