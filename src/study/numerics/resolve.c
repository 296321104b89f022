#include "resolve.h"

#include "cells.h"
#include "attractors/plan.h"
#include "kapitza/study_orbit.h"
#include "sweep/plan.h"

enum {
  SWEEP_VALUES = 9,  /* Values of a sweep that are tried, both ends included */
  LEAST_SAMPLES = 96 /* a period, that turning points and spectra need, however few are written */
};

/* How much faster than the sampled starts, after one drive period, others may become. */
static const double MARGIN = 1.05;
/* Method exact takes a smaller error than the tolerance, by this factor, where rounding allows: its steps cost less
 * than the cells that would be doubtful. Measured: 1 makes whole runs a sixth longer, and 30 is not reached by most
 * pendulums. */
static const double EXACT_PART = 0.1;

/* The motions for which one numerics must be accurate. */
typedef struct {
  kz_pendulum pendulum[SWEEP_VALUES];
  int count;
  double fastest, tolerance; /* rad per drive radian; rad */
} demand;

bool kz_is_processed(int32_t scheme) {
  return scheme == kz_scheme_find("processed");
}

double kz_fastest_motion(const kz_pendulum *pendulum, const kz_window *window, int64_t rows) {
  const kz_numerics numerics = kz_steps_plain();
  double fastest = MARGIN * kz_max_velocity(pendulum, &numerics, window);
  if (rows > 5) { /* two rows of nodes beyond the states on either side */
    const double top = fastest * (double)(rows - 1) / (double)(rows - 5);
    const kz_window nodes = {window->theta_min, window->theta_max, -top, top};
    fastest = MARGIN * kz_max_velocity(pendulum, &numerics, &nodes);
  }
  return fastest;
}

/* Windows of the scene's studies, at the pendulum numbered `last`. */
static void add_window(demand *d, const kz_axis *theta, const kz_axis *velocity, int64_t rows) {
  const kz_window window = kz_motions_window(theta, velocity);
  d->fastest = fmax(d->fastest, kz_fastest_motion(d->pendulum + d->count - 1, &window, rows));
}

static void add_basin(demand *d, const kz_basin_plan *plan) {
  add_window(d, &plan->theta, &plan->velocity, plan->method == KZ_METHOD_ICM ? plan->table_velocity : 0);
  if (plan->method != KZ_METHOD_EXACT) d->tolerance = fmin(d->tolerance, kz_steps_tolerance(plan));
}

static void add_pendulum(demand *d, const kz_scene *scene) {
  bool follows = scene->has_basin;
  for (int i = 0; i < kz_study_count; i++)
    follows = follows || (kz_studies[i]->window && kz_study_is_wanted(kz_studies[i], scene));
  if (!(scene->parameters.pendulum.beta > 0) || !follows) return;
  d->pendulum[d->count++] = scene->parameters.pendulum;
  if (scene->has_basin) add_basin(d, scene->basin);
  for (int i = 0; i < kz_study_count; i++) {
    if (!kz_studies[i]->window || !kz_study_is_wanted(kz_studies[i], scene)) continue;
    const kz_axis *axis[2];
    kz_studies[i]->window(scene, axis);
    add_window(d, axis[0], axis[1], 0);
  }
}

/* The edges of a plane where measures follow motions; ends has steps of its own. */
static void add_plane(demand *d, const kz_sweep_plan *plan, const kz_scene *scene) {
  const int32_t parameter[] = {plan->x.parameter, plan->y.parameter};
  for (int64_t i = 0; i < 9; i++) {
    const int64_t column = i % 3 * (plan->x.values.count - 1) / 2, row = i / 3 * (plan->y.values.count - 1) / 2;
    const double value[] = {kz_axis_value(&plan->x.values, column), kz_axis_value(&plan->y.values, row)};
    if (i == 4 || !kz_pendulum_at(scene, 2, parameter, value, d->pendulum + d->count)) continue;
    d->count++;
    add_window(d, &plan->theta, &plan->velocity, 0);
  }
}

static void add_sweep(demand *d, const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  if (kz_sweep_is_plane(plan)) {
    if (kz_sweep_has_points(plan)) add_plane(d, plan, scene);
    return;
  }
  const int64_t n = plan->values.count < SWEEP_VALUES - 1 ? plan->values.count : SWEEP_VALUES - 1;
  for (int64_t i = 0; i < n; i++) {
    const double value = kz_sweep_value(plan, i * (plan->values.count - 1) / (n - 1));
    if (!kz_sweep_pendulum(scene, value, d->pendulum + d->count)) continue;
    d->count++;
    add_window(d, &plan->theta, &plan->velocity, 0);
    if (scene->has_basin) add_basin(d, scene->basin);
  }
  d->fastest = fmax(d->fastest, fabs(plan->start_velocity));
}

/* One numerics for all pendulums: it has the most steps and terms that any of them needs. */
static bool resolve_serve(const demand *d, kz_numerics *numerics) {
  const kz_numerics asked = *numerics;
  double error;
  for (int i = 0; i < d->count; i++) {
    kz_numerics one = asked;
    if (kz_numerics_choose(d->pendulum + i, d->tolerance, d->fastest, &one, &error) != KZ_OK) return false;
    one.steps_per_period = (int32_t)kz_larger(one.steps_per_period, numerics->steps_per_period);
    one.drift_terms = (int32_t)kz_larger(one.drift_terms, numerics->drift_terms);
    one.kick_terms = (int32_t)kz_larger(one.kick_terms, numerics->kick_terms);
    *numerics = one;
  }
  return d->count > 0;
}

static bool serve_method(const demand *d, int32_t method, kz_numerics *numerics) {
  demand finer = *d;
  kz_numerics fine = *numerics;
  finer.tolerance *= EXACT_PART;
  if (method != KZ_METHOD_EXACT || !resolve_serve(&finer, &fine)) return resolve_serve(d, numerics);
  *numerics = fine;
  return true;
}

/* Sets scene->numerics; false if nothing is labelled, or the processed splitting is not accurate enough. */
static bool choose_processed(kz_scene *scene) {
  demand d = {.tolerance = scene->asked.tolerance};
  kz_numerics numerics = {
      .scheme = scene->asked.scheme, .steps_per_period = scene->asked.steps_per_period, .series = scene->series};
  if (scene->has_basin && !isnan(scene->basin->accuracy)) return false;
  add_pendulum(&d, scene);
  if (scene->has_sweep) add_sweep(&d, scene);
  if (!serve_method(&d, scene->has_basin ? scene->basin->method : KZ_METHOD_DIRECT, &numerics)) return false;
  scene->numerics = numerics;
  return true;
}

kz_numerics kz_processed_or_split(const kz_pendulum *pendulum, kz_kept_series *series, int32_t method, double tolerance,
                                  double fastest) {
  demand d = {.pendulum = {*pendulum}, .count = 1, .fastest = fastest, .tolerance = tolerance};
  kz_numerics numerics = {.series = series};
  return serve_method(&d, method, &numerics) ? numerics : kz_steps_plain();
}

kz_step_motions kz_motions_of_basin(const kz_scene *scene) {
  kz_step_motions motions =
      kz_motions_of(scene, kz_axis_fastest(&scene->basin->velocity), "numerics.steps_per_period|basin.velocity");
  if (scene->basin->method == KZ_METHOD_EXACT) /* errors are followed: they need not be small beside a cell */
    motions.cell = kz_cell_size(scene->basin);
  else
    kz_motions_label_cells(scene->basin, &motions);
  return motions;
}

/* The scheme's own number of steps, or more for small cells; `enough`: or more for any cells. */
static void choose_steps(kz_scene *scene, bool enough) {
  kz_numerics chosen;
  scene->numerics.steps_per_period = kz_scheme_at(scene->numerics.scheme).default_steps;
  if (!scene->has_basin || !isnan(scene->basin->accuracy) || !(scene->parameters.pendulum.beta > 0)) return;
  const kz_step_motions motions = kz_motions_of_basin(scene);
  if ((enough || motions.refuse_above < KZ_STEPS_REFUSED) && kz_motions_find_steps(&motions, &chosen))
    scene->numerics = chosen;
}

void kz_numerics_resolve(kz_scene *scene) {
  const kz_numerics_keys *asked = &scene->asked;
  const bool processed = kz_is_processed(asked->scheme);
  if (processed && choose_processed(scene)) return;
  scene->numerics = (kz_numerics){.scheme = processed ? kz_scheme_find("split6") : asked->scheme,
                                  .steps_per_period = asked->steps_per_period,
                                  .series = scene->series};
  if (processed || asked->steps_per_period == KZ_AUTO) choose_steps(scene, processed);
}

static double resolve_multiple(double unit, double least) {
  return unit * ceil(least / unit);
}

/* Rad per drive radian: the fastest swing about an equilibrium. */
static double resolve_swing(const kz_pendulum *p) {
  return sqrt(kz_stiffness(p));
}

static double samples_of(const kz_scene *scene) {
  return resolve_multiple((double)scene->orbit->samples_per_period,
                          LEAST_SAMPLES * fmax(1, resolve_swing(&scene->parameters.pendulum)));
}

/* Within a period the processed splitting shows nothing. */
static int32_t orbit_scheme(const kz_scene *scene) {
  return kz_is_processed(scene->asked.scheme) ? kz_scheme_find("split6") : scene->asked.scheme;
}

double kz_orbit_steps(const kz_scene *scene) {
  const double start = isfinite(scene->orbit->velocity) ? fabs(scene->orbit->velocity) : 0;
  const double speed = 1 + 2 * resolve_swing(&scene->parameters.pendulum) + start;
  const int32_t steps = kz_scheme_at(orbit_scheme(scene)).default_steps;
  const double asked = scene->asked.steps_per_period == KZ_AUTO ? steps : scene->asked.steps_per_period;
  return resolve_multiple(samples_of(scene), fmax(asked, steps * speed / 2));
}

kz_numerics kz_orbit_numerics(const kz_scene *scene) {
  return (kz_numerics){.scheme = orbit_scheme(scene), .steps_per_period = (int32_t)kz_orbit_steps(scene)};
}

int64_t kz_orbit_samples(const kz_scene *scene) {
  return (int64_t)samples_of(scene);
}
