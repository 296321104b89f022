/* Study `orbit`: one motion, its strobe points, turning points and lines. One motion has no parallel parts: rank 0 records it. */
#include "orbit.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "numerics/step_check.h"
#include "exponent.h"
#include "settles_on.h"

/* Periods of an open record that the scene does not bound. */
enum { OPEN_PERIODS = 100 };
/* Periods that an open record is looked ahead, as a rule, and the most steps a period with which it is. */
enum { AHEAD_STEPS = 1500 };
/* Periods of the transient between two looks at stop requests: a few seconds. */
enum { STRETCH = 100000 };

kz_status kz_orbit_check(const kz_scene *scene) {
  const double start = scene->orbit.velocity;
  kz_motions motions = kz_motions_of(scene, isfinite(start) ? fabs(start) : 0, "numerics.steps_per_period|orbit.start|orbit");
  if (scene->orbit.model != KZ_PENDULUM) return KZ_OK;
  motions.numerics = kz_orbit_numerics(scene);
  return kz_motions_check(&motions);
}

static int64_t given(int64_t value, int64_t fallback) {
  return value > 0 ? value : fallback;
}

kz_cost kz_orbit_cost(const kz_scene *scene) {
  const kz_orbit_plan *plan = &scene->orbit;
  double periods = (double)given(plan->periods, OPEN_PERIODS), rows = periods * (double)plan->samples_per_period;
  double samples = fmax(96, (double)plan->samples_per_period) * periods;
  return (kz_cost){.cells = 0, .disk_bytes = 32 * rows + 300 * periods, .rank0_bytes = 80 * samples + 32 * rows};
}

/* The state and the period of an attractor, as the study before has written it. */
static kz_status recall(kz_store *store, int64_t id, kz_state *start, int64_t *period) {
  int64_t count;
  double n, *const values[] = {&n, &start->theta, &start->velocity};
  const char *const names[] = {"period", "strobe_theta", "strobe_velocity"};
  KZ_TRY(kz_store_length(store, "attractors", "attractor", &count));
  if (count == 0)
    return kz_fail(KZ_REFUSED,
                   "orbit.attractor: no attractor was found; give orbit.start, add damping, or choose another window");
  if (id >= count)
    return kz_fail(KZ_REFUSED,
                   "orbit.attractor: %lld is not the id of an attractor; the search found %lld, so choose an id below that",
                   (long long)id, (long long)count);
  for (int i = 0; i < 3; i++) KZ_TRY(kz_store_number(store, "attractors", names[i], (int64_t[]){id, 0}, values[i]));
  *period = (int64_t)n;
  if (n > 0) return KZ_OK;
  return kz_fail(KZ_REFUSED, "orbit.attractor: %lld is chaotic and never closes; choose another id, or give a start",
                 (long long)id);
}

/* Where the motion starts, on every rank; `period` of a listed attractor. Collective. */
static kz_status start(kz_orbit *orbit, const kz_run *run, kz_store *store) {
  const kz_orbit_plan *plan = orbit->plan;
  orbit->cycle = (kz_cycle){.state = {plan->theta, plan->velocity}, .period = given(plan->period, 0)};
  const bool recalls = plan->attractor >= 0 && kz_rank(run->ranks) == 0;
  KZ_TRY(
      kz_ranks_agree(run->ranks, recalls ? recall(store, plan->attractor, &orbit->cycle.state, &orbit->cycle.period) : KZ_OK));
  return kz_ranks_broadcast(run->ranks, &orbit->cycle, sizeof orbit->cycle);
}

typedef struct {
  const kz_model *model;
  int64_t periods;
  kz_state state;
} kz_stretch;

static kz_status skip_stretch(void *context, int64_t tile, void *record) {
  const kz_stretch *stretch = context;
  kz_state state = stretch->state;
  (void)tile;
  kz_model_skip(stretch->model, stretch->periods, &state);
  memcpy(record, &state, sizeof state);
  return KZ_OK;
}

/* The transient in stretches, so that a stop request is heard and what is done is kept. Collective. */
static kz_status skip_transient(kz_orbit *orbit, const kz_run *run) {
  const int64_t transient = orbit->plan->transient;
  for (int64_t done = 0; done < transient; done += STRETCH) {
    char name[32];
    snprintf(name, sizeof name, "transient %" PRId64, done / STRETCH + 1);
    const int64_t periods = transient - done < STRETCH ? transient - done : STRETCH;
    kz_stretch stretch = {&orbit->model, periods, orbit->cycle.state};
    const kz_stage stage = {.name = name,
                            .n_tiles = 1,
                            .record_bytes = sizeof(kz_state),
                            .work = skip_stretch,
                            .context = &stretch,
                            .keep = true,
                            .everywhere = true};
    KZ_TRY(kz_stage_run(run, &stage, &orbit->cycle.state));
  }
  return KZ_OK;
}

/* How an open record of the pendulum goes on: in chaos, or to which attractor. Motions so fast that this takes long are left
 * without an answer. */
static kz_status look_ahead(kz_orbit *orbit, const kz_model *model) {
  if (model->numerics.steps_per_period > AHEAD_STEPS) return KZ_OK;
  const kz_motion *motion = &orbit->motion;
  const int64_t last = motion->periods * motion->samples;
  const kz_state end = {remainder(motion->theta[last], 2 * M_PI), motion->velocity[last]};
  double fastest = 0;
  orbit->parting =
      kz_exponent_positive(orbit->lyapunov, orbit->lyapunov_error) && kz_exponent_stays_positive(model, end, orbit->lyapunov);
  if (orbit->parting) return KZ_OK;
  for (int64_t i = last - motion->samples; i <= last; i++) fastest = fmax(fastest, fabs(motion->velocity[i]));
  return kz_settles_on(model, end, fastest, orbit->settles_on);
}

/* The motion after the transient: its record and its features. */
static kz_status follow(kz_orbit *orbit) {
  const bool closed = orbit->plan->closed;
  const kz_state from = orbit->cycle.state;
  const int64_t period = orbit->cycle.period;
  if (closed) KZ_TRY(kz_cycle_close(&orbit->model, period, from, &orbit->cycle));
  int64_t periods = given(orbit->plan->periods, closed ? orbit->cycle.period : OPEN_PERIODS);
  if (periods < orbit->cycle.period) periods = orbit->cycle.period;
  KZ_TRY(kz_model_record(&orbit->model, periods, orbit->cycle.state, &orbit->motion));
  if (orbit->model.flow)
    kz_exponent_along(&orbit->model, periods, orbit->cycle.state, &orbit->lyapunov, &orbit->lyapunov_error);
  if (orbit->model.flow && closed) {
    orbit->lyapunov = log(hypot(orbit->cycle.re[0], orbit->cycle.im[0])) / (double)orbit->cycle.period;
    orbit->lyapunov_error = 0;
  }
  if (orbit->model.flow && !closed) KZ_TRY(look_ahead(orbit, &orbit->model));
  return kz_orbit_features_make(&orbit->motion, orbit->cycle.period, orbit->parting, &orbit->features);
}

static kz_status find_features(kz_orbit *orbit, kz_store *store, FILE *summary) {
  KZ_TRY(follow(orbit));
  KZ_TRY(kz_orbit_write(orbit, store));
  kz_orbit_print(orbit, summary);
  return KZ_OK;
}

static kz_status model(kz_orbit *orbit, const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_model_make(scene, &orbit->model);
  KZ_TRY(start(orbit, run, store));
  KZ_TRY(skip_transient(orbit, run));
  return kz_rank(run->ranks) == 0 ? find_features(orbit, store, summary) : KZ_OK;
}

static kz_orbit begin(const kz_scene *scene) {
  return (kz_orbit){.plan = &scene->orbit,
                    .pendulum = scene->parameters.pendulum,
                    .parameters = &scene->parameters,
                    .lyapunov = NAN,
                    .lyapunov_error = NAN};
}

static void end(kz_orbit *orbit) {
  kz_orbit_features_free(&orbit->features);
  kz_motion_free(&orbit->motion);
  kz_model_free(&orbit->model);
}

/* A short record from the start, or from somewhere where that is an attractor still to be found, and a part of the transient. */
kz_status kz_orbit_measure(const kz_scene *scene, double *seconds) {
  enum { FEW = 64 };
  kz_scene part = *scene;
  kz_orbit_plan *plan = &part.orbit;
  const double periods = (double)given(plan->periods, OPEN_PERIODS);
  plan->periods = given(plan->periods, OPEN_PERIODS) < FEW ? given(plan->periods, OPEN_PERIODS) : FEW;
  if (plan->attractor >= 0) plan->closed = false;
  kz_orbit orbit = begin(&part);
  orbit.cycle.state = plan->attractor >= 0 ? (kz_state){3, 0} : (kz_state){plan->theta, plan->velocity};
  orbit.cycle.period = plan->closed ? given(plan->period, 0) : 0;
  kz_model_make(&part, &orbit.model);
  const double start = kz_processor_clock();
  kz_state state = orbit.cycle.state;
  kz_model_skip(&orbit.model, FEW, &state);
  const double skipped = kz_processor_clock();
  if (follow(&orbit) != KZ_OK) kz_message_clear(); /* the run says so */
  *seconds += (skipped - start) / FEW * (double)plan->transient +
              (kz_processor_clock() - skipped) * fmax(1, periods / (double)plan->periods);
  end(&orbit);
  return KZ_OK;
}

kz_status kz_orbit_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_orbit orbit = begin(scene);
  const kz_status status = model(&orbit, scene, run, store, summary);
  end(&orbit);
  return status;
}
