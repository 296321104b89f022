/* Motions: the map of drive periods, orbits in continuous time, manifolds. */
#include "../library.h"
#include "kapitza/dynamics_saddles.h"
#include "kapitza/study_orbit.h"
#include "kapitza/study_release.h"

enum { STRETCH = 4096 }; /* drive periods between two looks at the caller */

/* ---- the map ---- */

typedef struct {
  int64_t n, periods;
  double *theta, *velocity;
  int64_t *turns;
  double *tangent;
} map_job;

/* The pendulum in reversed time: with (theta, -velocity) it obeys the equation with -beta and the drive turned back. */
static kz_pendulum motion_reversed(const kz_pendulum *pendulum) {
  kz_pendulum back = *pendulum;
  back.beta = -back.beta;
  for (int i = 0; i < KZ_HARMONICS; i++) {
    back.vertical[i][1] = -back.vertical[i][1];
    back.horizontal[i][1] = -back.horizontal[i][1];
  }
  return back;
}

static const kz_flow *flow_of(kapitza_pendulum *p, bool backwards) {
  if (p->flow[backwards]) return p->flow[backwards];
  kz_pendulum pendulum = p->scene.parameters.pendulum;
  if (backwards) pendulum = motion_reversed(&pendulum);
  kz_numerics numerics;
  kz_numerics_fine(&pendulum, &numerics);
  return p->flow[backwards] = kz_flow_create(&pendulum, &numerics);
}

/* In reversed time velocities have the other sign, and so have the entries of the tangent beside the diagonal. */
static void turn_velocities(const map_job *j) {
  for (int64_t i = 0; i < j->n; i++) j->velocity[i] = -j->velocity[i];
}

/* tangent [n][2][2] becomes `later` times it. */
static void motion_multiply(int64_t n, const double *later, double *tangent) {
  for (int64_t i = 0; i < n; i++) {
    const double *a = later + 4 * i,
                 b[4] = {tangent[4 * i], tangent[4 * i + 1], tangent[4 * i + 2], tangent[4 * i + 3]};
    for (int e = 0; e < 4; e++) tangent[4 * i + e] = a[e & 2] * b[e & 1] + a[(e & 2) + 1] * b[2 + (e & 1)];
  }
}

static kz_status move_all(const map_job *j, const kz_flow *flow, int64_t periods, int64_t *turns, double *later) {
  for (int64_t done = 0; done < periods; done += STRETCH) {
    const int64_t part = periods - done < STRETCH ? periods - done : STRETCH;
    if (!later) {
      kz_advance(flow, j->n, part, j->theta, j->velocity, turns);
      continue;
    }
    kz_advance_tangent(flow, j->n, part, j->theta, j->velocity, turns, later);
    motion_multiply(j->n, later, j->tangent);
  }
  return KZ_OK;
}

static kz_status work_map(kapitza_pendulum *p, void *context) {
  const map_job *j = context;
  const bool backwards = j->periods < 0;
  const kz_flow *flow = flow_of(p, backwards);
  KZ_TRY(kz_memory_ask("n", (size_t)j->n * (sizeof(int64_t) + 4 * sizeof(double))));
  KZ_AUTOFREE int64_t *turns = kz_calloc((size_t)j->n + 1, sizeof *turns);
  KZ_AUTOFREE double *later = j->tangent ? kz_malloc((size_t)j->n * 4 * sizeof *later + 1) : NULL;
  for (int64_t i = 0; j->tangent && i < 4 * j->n; i++) j->tangent[i] = i % 4 == 0 || i % 4 == 3;
  if (backwards) turn_velocities(j);
  KZ_TRY(move_all(j, flow, llabs(j->periods), turns, later));
  if (backwards) turn_velocities(j);
  for (int64_t i = 0; i < j->n; i++) {
    j->theta[i] = j->theta[i] >= M_PI ? -M_PI : j->theta[i] + 0.0;
    if (j->turns) j->turns[i] = turns[i];
    for (int e = 1; backwards && j->tangent && e < 3; e++) j->tangent[4 * i + e] = -j->tangent[4 * i + e];
  }
  return KZ_OK;
}

/* The states are copies until all is done: a call that is left leaves the caller's as they were. */
static kz_status work_map_copied(kapitza_pendulum *p, void *context) {
  const map_job *j = context;
  const size_t bytes = (size_t)j->n * sizeof(double);
  KZ_TRY(kz_memory_ask("n", 2 * bytes));
  KZ_AUTOFREE double *theta = kz_malloc(bytes + 1), *velocity = kz_malloc(bytes + 1);
  memcpy(theta, j->theta, bytes);
  memcpy(velocity, j->velocity, bytes);
  map_job own = *j;
  own.theta = theta;
  own.velocity = velocity;
  KZ_TRY(work_map(p, &own));
  memcpy(j->theta, theta, bytes);
  memcpy(j->velocity, velocity, bytes);
  return KZ_OK;
}

kapitza_status kapitza_map(kapitza_pendulum *pendulum, int64_t n, int64_t periods, double *theta, double *velocity,
                           int64_t *turns, double *tangent) {
  map_job job = {n, periods, theta, velocity, turns, tangent};
  return kz_library_call(pendulum, work_map_copied, &job);
}

/* ---- orbits ---- */

typedef struct {
  kz_orbit_plan plan;
  double *theta, *velocity;
} orbit_job;

static kz_status pause_orbit(void *context) {
  (void)context;
  kz_look();
  return KZ_OK;
}

static kz_status work_orbit(kapitza_pendulum *p, void *context) {
  orbit_job *j = context;
  kz_scene scene = p->scene;
  scene.orbit = &j->plan;
  const kz_release release = kz_release_of(&scene, &scene.parameters.pendulum);
  if (kz_release_strobes(&release) > 0)
    return kz_fail(KZ_REFUSED,
                   "an orbit begins at phase 0 and without a ramp; leave out basin.start_phase and pendulum.ramp");
  if (j->plan.samples_per_period < 1 || j->plan.periods < 0 || j->plan.transient < 0)
    return kz_fail(KZ_REFUSED, "periods, transient and samples must not be negative, and samples not 0");
  KZ_TRY(kz_memory_ask("periods", (size_t)(j->plan.periods * j->plan.samples_per_period + 1) * 2 * sizeof(double)));
  return kz_orbit_record(&scene, pause_orbit, NULL, j->theta, j->velocity);
}

kapitza_status kapitza_orbit(kapitza_pendulum *pendulum, double theta, double velocity, int64_t transient,
                             int64_t periods, int64_t samples, double *theta_out, double *velocity_out) {
  orbit_job job = {{.theta = theta,
                    .velocity = velocity,
                    .attractor = INT64_MIN,
                    .model = KZ_PENDULUM,
                    .transient = transient,
                    .periods = periods,
                    .samples_per_period = samples,
                    .period = INT64_MIN},
                   theta_out,
                   velocity_out};
  return kz_library_call(pendulum, work_orbit, &job);
}

/* ---- manifolds ---- */

typedef struct {
  kz_branch branch;
  int64_t most, *count;
  double *point;
} manifold_job;

static kz_status work_manifold(kapitza_pendulum *p, void *context) {
  const manifold_job *j = context;
  const kz_branch *b = &j->branch;
  if (j->most < 1 || b->period < 1 || abs(b->side) != 1 || (b->stable != 0 && b->stable != 1) || !(b->spacing > 0) ||
      !(b->length > 0) || !(b->fastest > 0))
    return kz_fail(KZ_REFUSED,
                   "a manifold needs period >= 1, side 1 or -1, stable 0 or 1, and positive spacing, length and "
                   "largest speed");
  *j->count = kz_manifold_grow(&p->scene.parameters.pendulum, b, j->most, j->point);
  return KZ_OK;
}

kapitza_status kapitza_manifold(kapitza_pendulum *pendulum, double theta, double velocity, int32_t period,
                                int32_t stable, int32_t side, double spacing, double length, double fastest,
                                int64_t most, double *point, int64_t *count) {
  manifold_job job = {{theta, velocity, period, stable, side, spacing, length, fastest}, most, count, point};
  return kz_library_call(pendulum, work_manifold, &job);
}
