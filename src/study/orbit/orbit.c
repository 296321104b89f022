/* Study `orbit`: one motion, strobe points, turning points, lines. Nothing is parallel: rank 0 records it. */
#include "orbit.h"

#include <inttypes.h>

#include "labelling/listed.h"
#include "numerics/step_check.h"
#include "kapitza/dynamics_cycles.h"

/* ---- closed orbits: their period and their exact place ---- */

/* A cycle must lie this near to the start (rad), or Newton has gone to another one. */
static const double MAX_DISTANCE = 0.3;
/* Linear orbits count as closed when they come back to this share of their size. */
static const double CLOSED = 1e-9;
enum { MOST_PERIODS = 512 };

/* Newton from `start` for period n; the cycle then has its smallest period. */
static bool close_with(const kz_model *model, int64_t n, kz_state orbit_start, kz_cycle *cycle) {
  KZ_AUTOFREE double *theta = kz_malloc((size_t)n * sizeof *theta), *velocity = kz_malloc((size_t)n * sizeof *velocity);
  theta[0] = orbit_start.theta;
  velocity[0] = orbit_start.velocity;
  kz_dynamics_close_cycle(&model->pendulum, &model->numerics, n, MAX_DISTANCE, theta, velocity, &cycle->row);
  cycle->period = cycle->row.period;
  cycle->state = (kz_state){theta[0], velocity[0]};
  return cycle->period > 0;
}

/* The shortest return within ever wider distances that Newton confirms. */
static kz_status find_cycle(const kz_model *model, kz_state start, kz_cycle *cycle) {
  static const double WITHIN[] = {1e-6, 1e-4, 1e-2, 1e-1};
  double back[MOST_PERIODS + 1];
  kz_state x = start;
  for (int n = 1; n <= MOST_PERIODS; n++) {
    kz_model_skip(model, 1, &x);
    back[n] = hypot(remainder(x.theta - start.theta, 2 * M_PI), x.velocity - start.velocity);
  }
  for (size_t i = 0; i < sizeof WITHIN / sizeof WITHIN[0]; i++) {
    for (int n = 1; n <= MOST_PERIODS; n++)
      if (back[n] < WITHIN[i] && close_with(model, n, start, cycle)) return KZ_OK;
  }
  return kz_fail(
      KZ_REFUSED,
      "orbit.closed: no cycle of up to %d periods near theta = %.9g, velocity = %.9g; give a nearer start, a longer "
      "transient, or the period",
      MOST_PERIODS, start.theta, start.velocity);
}

/* The linear model scales: its orbits close or not. */
static kz_status check_linear(const kz_model *model, int64_t period, kz_state start, kz_cycle *cycle) {
  *cycle = (kz_cycle){start, period, {.multiplier_re = {NAN, NAN}, .multiplier_im = {NAN, NAN}}};
  kz_state orbit_end = start;
  kz_model_skip(model, period, &orbit_end);
  double gap = hypot(orbit_end.theta - start.theta, orbit_end.velocity - start.velocity);
  if (gap <= CLOSED * hypot(start.theta - model->origin, start.velocity)) return KZ_OK;
  return kz_fail(
      KZ_REFUSED,
      "orbit.closed: the linear motion ends %.3g from its start after %lld periods; choose parameters on a curve of "
      "this period, or leave closed out",
      gap, (long long)period);
}

/* The cycle at or near `start`: of the given period, or (period = 0) of the shortest that the orbit comes back to.
 * Newton's method on the strobe map for the pendulum; for the linear model the orbit itself must close. KZ_REFUSED says
 * what was found instead. */
static kz_status close_cycle(const kz_model *model, int64_t period, kz_state start, kz_cycle *cycle) {
  if (!model->flow) return check_linear(model, period, start, cycle);
  if (period == 0) return find_cycle(model, start, cycle);
  if (!close_with(model, period, start, cycle))
    return kz_fail(
        KZ_REFUSED,
        "orbit.closed: no cycle of %lld periods within %g of theta = %.9g, velocity = %.9g; give a nearer start",
        (long long)period, MAX_DISTANCE, start.theta, start.velocity);
  if (cycle->period == period) return KZ_OK;
  return kz_fail(
      KZ_REFUSED,
      "orbit.period: is %lld, but the cycle found there closes after %lld; give that period, or a nearer start",
      (long long)period, (long long)cycle->period);
}

/* Periods of an open record that the scene does not bound. */
enum { OPEN_PERIODS = 100 };
/* Periods of the transient between two looks at stop requests: a few seconds. */
enum { STRETCH = 100000 };

kz_status kz_orbit_check(const kz_scene *scene) {
  const double start = scene->orbit->velocity;
  kz_step_motions motions =
      kz_motions_of(scene, isfinite(start) ? fabs(start) : 0, "numerics.steps_per_period|orbit.start|orbit");
  if (scene->orbit->model != KZ_PENDULUM) return KZ_OK;
  motions.numerics = kz_orbit_numerics(scene);
  return kz_motions_check(&motions);
}

static int64_t orbit_given(int64_t value, int64_t fallback) {
  return value > 0 ? value : fallback;
}

kz_cost kz_orbit_cost(const kz_scene *scene) {
  const kz_orbit_plan *plan = scene->orbit;
  double periods = (double)orbit_given(plan->periods, OPEN_PERIODS), rows = periods * (double)plan->samples_per_period;
  double samples = fmax(96, (double)plan->samples_per_period) * periods;
  return (kz_cost){.cells = 0, .disk_bytes = 32 * rows + 300 * periods, .rank0_bytes = 80 * samples + 32 * rows};
}

/* The state and the period of an attractor that the study before has written. */
static kz_status orbit_recall(const kz_listed *known, int64_t id, kz_cycle *cycle) {
  if (known->count == 0)
    return kz_fail(KZ_REFUSED,
                   "orbit.attractor: no attractor was found; give orbit.start, add damping, or choose another window");
  if (id >= known->count)
    return kz_fail(
        KZ_REFUSED,
        "orbit.attractor: %lld is not the id of an attractor; the search found %lld, so choose an id below that",
        (long long)id, (long long)known->count);
  cycle->state = (kz_state){known->theta[id * known->phases], known->velocity[id * known->phases]};
  cycle->period = (int64_t)known->period[id];
  if (cycle->period > 0) return KZ_OK;
  return kz_fail(KZ_REFUSED, "orbit.attractor: %lld never closes; choose another id, or give a start", (long long)id);
}

/* Where the motion starts, on every rank; its period if it is a listed attractor. Collective. */
static kz_status orbit_start_of(kz_orbit *orbit, const kz_run *run, kz_store *store) {
  const kz_orbit_plan *plan = orbit->scene->orbit;
  orbit->cycle = (kz_cycle){.state = {plan->theta, plan->velocity}, .period = orbit_given(plan->period, 0)};
  if (plan->attractor < 0) return KZ_OK;
  KZ_AUTOFREE_BY(kz_listed_free) kz_listed known;
  KZ_TRY(kz_listed_read(run, store, "attractors", "attractor", &known));
  return kz_ranks_agree(run->ranks, orbit_recall(&known, plan->attractor, &orbit->cycle));
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

/* Skips the transient in stretches: a stop request ends it between two, and what is done is kept. Collective. */
static kz_status skip_transient(kz_orbit *orbit, const kz_run *run) {
  const int64_t transient = orbit->scene->orbit->transient;
  for (int64_t done = 0; done < transient; done += STRETCH) {
    char name[32];
    snprintf(name, sizeof name, "transient %" PRId64, done / STRETCH + 1);
    const int64_t periods = transient - done < STRETCH ? transient - done : STRETCH;
    kz_stretch stretch = {&orbit->model, periods, orbit->cycle.state};
    const kz_stage stage = kz_stage_for_all(name, 1, sizeof(kz_state), skip_stretch, &stretch);
    KZ_TRY(kz_stage_run(run, &stage, &orbit->cycle.state));
  }
  return KZ_OK;
}

/* The motion after the transient: its record and its features. */
static kz_status orbit_follow(kz_orbit *orbit) {
  const kz_orbit_plan *plan = orbit->scene->orbit;
  kz_cycle *cycle = &orbit->cycle;
  if (plan->closed) KZ_TRY(close_cycle(&orbit->model, cycle->period, cycle->state, cycle));
  int64_t periods = orbit_given(plan->periods, plan->closed ? cycle->period : OPEN_PERIODS);
  if (periods < cycle->period) periods = cycle->period;
  KZ_TRY(kz_model_record(&orbit->model, periods, cycle->state, &orbit->motion));
  if (orbit->model.flow && plan->closed) {
    orbit->lyapunov = log(hypot(cycle->row.multiplier_re[0], cycle->row.multiplier_im[0])) / (double)cycle->period;
    orbit->lyapunov_error = 0;
  } else if (orbit->model.flow) {
    kz_orbit_exponent(orbit);
    KZ_TRY(kz_orbit_look_ahead(orbit));
  }
  return kz_orbit_features_make(orbit);
}

static kz_orbit orbit_begin(const kz_scene *scene) {
  kz_orbit orbit = {.scene = scene, .lyapunov = NAN, .lyapunov_error = NAN};
  kz_model_make(scene, &orbit.model);
  return orbit;
}

static void orbit_close(kz_orbit *orbit) {
  free(orbit->features.amplitude);
  free(orbit->features.phase);
  free(orbit->features.turning);
  free(orbit->motion.theta);
  free(orbit->motion.velocity);
  kz_model_free(&orbit->model);
}

kz_status kz_orbit_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(orbit_close) kz_orbit orbit = orbit_begin(scene);
  KZ_TRY(orbit_start_of(&orbit, run, store));
  KZ_TRY(skip_transient(&orbit, run));
  if (!store) return KZ_OK;
  KZ_TRY(orbit_follow(&orbit));
  KZ_TRY(kz_orbit_write(&orbit, store));
  kz_orbit_print(&orbit, summary);
  return KZ_OK;
}
