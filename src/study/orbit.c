/* Study `orbit`: one motion, its strobe points, turning points and lines. One rank does it all: it is one motion. */
#include "orbit.h"

#include <math.h>

#include "exponent.h"

/* Periods of an open record that the scene does not bound. */
enum { OPEN_PERIODS = 100 };

bool kz_orbit_wanted(const kz_scene *scene) {
  return scene->has_orbit;
}

static int64_t given(int64_t value, int64_t fallback) {
  return value > 0 ? value : fallback;
}

kz_cost kz_orbit_cost(const kz_scene *scene) {
  const kz_orbit_plan *plan = &scene->orbit;
  double periods = (double)given(plan->periods, OPEN_PERIODS), rows = periods * (double)plan->samples_per_period;
  double samples = fmax(96, (double)plan->samples_per_period) * periods;
  return (kz_cost){.cells = 0,
                   .disk_bytes = 32 * rows + 300 * periods,
                   .memory_bytes = 80 * samples + 32 * rows,
                   .core_seconds = 1e-4 * (periods + (double)plan->transient)};
}

/* The state and the period of an attractor, as the study before has written it. */
static kz_status recall(kz_store *store, int64_t id, kz_state *start, int64_t *period) {
  int64_t count;
  double n, *const values[] = {&n, &start->theta, &start->velocity};
  const char *const names[] = {"period", "strobe_theta", "strobe_velocity"};
  KZ_TRY(kz_store_length(store, "attractors", "attractor", &count));
  if (id >= count)
    return kz_fail(KZ_FAILED, "orbit.attractor: %lld is not in the catalogue, which has %lld; an id below that", (long long)id,
                   (long long)count);
  for (int i = 0; i < 3; i++) KZ_TRY(kz_store_number(store, "attractors", names[i], (int64_t[]){id, 0}, values[i]));
  *period = (int64_t)n;
  if (n > 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "orbit.attractor: %lld is chaotic and never closes; another id, or a start", (long long)id);
}

/* The motion that the scene asks for, recorded and portrayed. */
static kz_status follow(kz_orbit *orbit, kz_store *store) {
  const kz_orbit_plan *plan = orbit->plan;
  const bool listed = plan->attractor >= 0, closed = plan->closed;
  kz_state start = {plan->theta, plan->velocity};
  int64_t period = given(plan->period, 0);
  if (listed) KZ_TRY(recall(store, plan->attractor, &start, &period));
  if (plan->transient > 0) kz_mover_skip(&orbit->mover, plan->transient, &start);
  orbit->cycle = (kz_cycle){.state = start};
  if (closed) KZ_TRY(kz_cycle_close(&orbit->mover, period, start, &orbit->cycle));
  int64_t periods = given(plan->periods, closed ? orbit->cycle.period : OPEN_PERIODS);
  if (periods < orbit->cycle.period) periods = orbit->cycle.period;
  KZ_TRY(kz_mover_record(&orbit->mover, periods, orbit->cycle.state, &orbit->motion));
  if (orbit->mover.plan)
    kz_exponent_along(&orbit->mover, periods, orbit->cycle.state, &orbit->lyapunov, &orbit->lyapunov_error);
  if (orbit->mover.plan && closed) {
    orbit->lyapunov = log(hypot(orbit->cycle.re[0], orbit->cycle.im[0])) / (double)orbit->cycle.period;
    orbit->lyapunov_error = 0;
  }
  return kz_portrait_make(&orbit->motion, orbit->cycle.period, &orbit->portrait);
}

static kz_status model(kz_orbit *orbit, const kz_scene *scene, kz_store *store, FILE *summary) {
  KZ_TRY(kz_mover_make(scene, &orbit->mover));
  KZ_TRY(follow(orbit, store));
  KZ_TRY(kz_orbit_write(orbit, store));
  kz_orbit_print(orbit, summary);
  return KZ_OK;
}

kz_status kz_orbit_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary) {
  if (kz_team_rank(team) != 0) return KZ_OK;
  kz_orbit orbit = {.plan = &scene->orbit, .pendulum = scene->parameters.pendulum, .lyapunov = NAN, .lyapunov_error = NAN};
  kz_status status = model(&orbit, scene, store, summary);
  kz_portrait_free(&orbit.portrait);
  kz_motion_free(&orbit.motion);
  kz_mover_free(&orbit.mover);
  return status;
}
