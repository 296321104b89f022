/* Study `orbit`: one motion, its strobe points, turning points and lines. One rank does it all: it is one motion. */
#include "orbit.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "portrait.h"

static const double PI = 3.14159265358979323846;
static const char *const GROUP = "orbit";

/* Periods of an open record that the scene does not bound. */
enum { OPEN_PERIODS = 100 };

typedef struct {
  const kz_orbit_plan *plan;
  kz_pendulum pendulum;
  kz_mover mover;
  kz_cycle cycle; /* of a closed orbit; period 0 = open */
  kz_motion motion;
  kz_portrait portrait;
} kz_orbit;

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
  const bool listed = plan->attractor >= 0, closed = plan->closed || listed;
  kz_state start = {plan->theta, plan->velocity};
  int64_t period = given(plan->period, 0);
  if (listed) KZ_TRY(recall(store, plan->attractor, &start, &period));
  if (plan->transient > 0) kz_mover_skip(&orbit->mover, plan->transient, &start);
  orbit->cycle = (kz_cycle){.state = start};
  if (closed) KZ_TRY(kz_cycle_close(&orbit->mover, period, start, &orbit->cycle));
  int64_t periods = given(plan->periods, closed ? orbit->cycle.period : OPEN_PERIODS);
  if (periods < orbit->cycle.period) periods = orbit->cycle.period;
  KZ_TRY(kz_mover_record(&orbit->mover, periods, orbit->cycle.state, &orbit->motion));
  return kz_portrait_make(&orbit->motion, orbit->cycle.period, &orbit->portrait);
}

/* Every `stride`-th value, count of them, in a new array. NULL where memory ran out. */
static double *every(const double *from, int64_t stride, int64_t count) {
  double *to = malloc((size_t)count * sizeof *to + 1); /* + 1: an empty array is no lack of memory */
  for (int64_t i = 0; to && i < count; i++) to[i] = from[i * stride];
  return to;
}

/* unit * (0, 1, 2, ...) / parts */
static double *ramp(double unit, int64_t parts, int64_t count) {
  double *to = malloc((size_t)count * sizeof *to);
  for (int64_t i = 0; to && i < count; i++) to[i] = unit * (double)i / (double)parts;
  return to;
}

static double *pivot(double m, int64_t samples, int64_t count) {
  double *to = malloc((size_t)count * sizeof *to);
  for (int64_t i = 0; to && i < count; i++) to[i] = m * cos(2 * PI * (double)(i % samples) / (double)samples);
  return to;
}

/* Writes one array and frees it. */
static kz_status put(kz_store *store, const char *name, bool dimension, int64_t count, double *values) {
  if (!values) return kz_fail(KZ_FAILED, "out of memory for %s of an orbit", name);
  kz_status status =
      dimension ? kz_store_dimension(store, GROUP, name, count, values) : kz_store_variable(store, GROUP, name, values);
  free(values);
  return status;
}

static kz_status write_series(const kz_orbit *orbit, kz_store *store) {
  const kz_motion *motion = &orbit->motion;
  int64_t samples = orbit->plan->samples_per_period, stride = motion->samples / samples, n = motion->periods * samples + 1;
  KZ_TRY(put(store, "time", true, n, ramp(2 * PI, samples, n)));
  KZ_TRY(put(store, "theta", false, n, every(motion->theta, stride, n)));
  KZ_TRY(put(store, "velocity", false, n, every(motion->velocity, stride, n)));
  KZ_TRY(put(store, "pivot", false, n, pivot(orbit->pendulum.m, samples, n)));
  n = motion->periods + 1;
  KZ_TRY(put(store, "strobe_time", true, n, ramp(2 * PI, 1, n)));
  KZ_TRY(put(store, "strobe_theta", false, n, every(motion->theta, motion->samples, n)));
  return put(store, "strobe_velocity", false, n, every(motion->velocity, motion->samples, n));
}

static kz_status write_portrait(const kz_portrait *portrait, kz_store *store) {
  const double *turning = &portrait->turning->time; /* pairs (time, angle) */
  int64_t n = portrait->n_turning;
  KZ_TRY(put(store, "maximum_time", true, n, every(turning, 2, n)));
  KZ_TRY(put(store, "maximum_angle", false, n, every(turning + 1, 2, n)));
  KZ_TRY(put(store, "line_frequency", true, portrait->n_lines, ramp(1, portrait->record_periods, portrait->n_lines)));
  KZ_TRY(kz_store_variable(store, GROUP, "line_amplitude", portrait->amplitude));
  return kz_store_variable(store, GROUP, "line_phase", portrait->phase);
}

static kz_status write_attributes(const kz_orbit *orbit, kz_store *store) {
  static const char *const MODEL[] = {"pendulum", "mathieu", "effective"};
  const kz_portrait *p = &orbit->portrait;
  const struct {
    const char *name;
    int64_t value;
  } integers[] = {{"period", p->period},          {"winding", p->winding}, {"centre", p->centre},
                  {"dominant_line", p->dominant}, {"closed", p->closed},   {"symmetric", p->symmetric}};
  for (size_t i = 0; i < sizeof integers / sizeof integers[0]; i++)
    KZ_TRY(kz_store_integer(store, GROUP, integers[i].name, integers[i].value));
  KZ_TRY(kz_store_text(store, GROUP, "name", p->name));
  KZ_TRY(kz_store_text(store, GROUP, "model", MODEL[orbit->plan->model]));
  if (!p->closed || orbit->plan->model != KZ_PENDULUM) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "multiplier_re", orbit->cycle.re[0]));
  return kz_store_real(store, GROUP, "multiplier_im", orbit->cycle.im[0]);
}

static void summarise(const kz_orbit *orbit, FILE *summary) {
  const kz_portrait *p = &orbit->portrait;
  if (p->closed)
    fprintf(summary, "orbit: %s, closes after %" PRId64 " period%s", p->name, p->period, p->period > 1 ? "s" : "");
  else if (p->period > 0)
    fprintf(summary, "orbit: open record of %" PRId64 " periods; its lines tell n = %" PRId64 " (%s)", orbit->motion.periods,
            p->period, p->name);
  else
    fprintf(summary, "orbit: open record of %" PRId64 " periods; its lines tell no period", orbit->motion.periods);
  if (p->dominant > 0)
    fprintf(summary, ", largest line %.6g rad at %" PRId64 "/%" PRId64 " of the drive", p->amplitude[p->dominant], p->dominant,
            p->record_periods);
  fprintf(summary, "\n");
}

static kz_status model(kz_orbit *orbit, const kz_scene *scene, kz_store *store, FILE *summary) {
  KZ_TRY(kz_mover_make(scene, &orbit->mover));
  KZ_TRY(follow(orbit, store));
  KZ_TRY(write_series(orbit, store));
  KZ_TRY(write_portrait(&orbit->portrait, store));
  KZ_TRY(write_attributes(orbit, store));
  summarise(orbit, summary);
  return KZ_OK;
}

kz_status kz_orbit_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary) {
  if (kz_team_rank(team) != 0) return KZ_OK;
  kz_orbit orbit = {.plan = &scene->orbit, .pendulum = scene->parameters.pendulum};
  kz_status status = model(&orbit, scene, store, summary);
  kz_portrait_free(&orbit.portrait);
  kz_motion_free(&orbit.motion);
  kz_mover_free(&orbit.mover);
  return status;
}
