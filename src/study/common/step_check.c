/* Whether the steps are fine enough for a scene: step doubling on a sample of every class of speeds. */
#include "step_check.h"

#include <float.h>
#include <math.h>

#include "accuracy/reference.h"
#include "cells.h"
#include "steps_trial.h"
#include "sweep/sweep.h"

enum {
  DOUBLINGS = 8,       /* of the steps that are tried as advice */
  MOST_STEPS = 100000, /* that a scene can ask for */
  SWEEP_VALUES = 17,   /* of a sweep that are tried, fewer where they take many steps */
  SWEEP_STEPS = 20000  /* that these values take together */
};

/* rad, errors of one drive period: above LOOSE the user is warned; above LOST labels would be random, and the scene is
 * refused. */
static const double LOOSE = 1e-4, LOST = 0.1;
/* The same in cells of a basin, where a hundredth of a cell is less than LOOSE: a picture that is shifted by so much. */
static const double LOOSE_CELLS = 0.01, LOST_CELLS = 0.1;

double kz_steps_tolerance(const kz_basin_plan *plan) {
  return fmin(LOOSE, LOOSE_CELLS * kz_cell_size(plan));
}

bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  const kz_step_trial classes = kz_try_steps(pendulum, numerics, fastest);
  return kz_worst_error(&classes) <= LOST;
}

/* Motions of one study: what they are tried with, and the keys that a user could change. */
typedef struct {
  kz_pendulum pendulum;
  kz_numerics numerics;
  double fastest;     /* start, rad per drive radian */
  double loose, lost; /* rad, of one drive period: warned of above, refused above */
  double cell;        /* rad; INFINITY where nothing has cells */
  const char *keys;   /* "KEY|KEY" */
  char where[96];     /* "at m = 0.3, ", or "" */
} motions;

static motions motions_of(const kz_scene *scene, double fastest, const char *keys) {
  return (motions){scene->parameters.pendulum, scene->numerics, fastest, LOOSE, LOST, INFINITY, keys, ""};
}

/* The same where a basin's cells are labelled. */
static void hold_against_cells(const kz_basin_plan *plan, motions *m) {
  m->cell = kz_cell_size(plan);
  m->loose = kz_steps_tolerance(plan);
  if (m->loose < LOOSE) m->lost = LOST_CELLS * m->cell;
}

static motions motions_of_basin(const kz_scene *scene) {
  motions m = motions_of(scene, kz_axis_fastest(&scene->basin.velocity), "numerics.steps_per_period|basin.velocity");
  hold_against_cells(&scene->basin, &m);
  return m;
}

/* Steps that leave nothing to warn of; where rounding forbids that in small cells, steps that are not refused. */
static bool find_steps(const motions *m, kz_numerics *numerics) {
  const int32_t most = (int32_t)fmin(MOST_STEPS, ldexp(m->numerics.steps_per_period, DOUBLINGS));
  *numerics = m->numerics;
  if (kz_steps_enough(&m->pendulum, m->fastest, m->loose, most, numerics)) return true;
  if (m->lost >= LOST) return false;
  *numerics = m->numerics;
  return kz_steps_enough(&m->pendulum, m->fastest, m->lost, most, numerics);
}

void kz_steps_choose(kz_scene *scene) {
  kz_numerics chosen;
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  scene->numerics.steps_per_period = scheme.default_steps;
  if (!scene->has_basin || !isnan(scene->basin.accuracy) || !(scene->parameters.pendulum.beta > 0)) return;
  const motions m = motions_of_basin(scene);
  if (m.lost < LOST && find_steps(&m, &chosen)) scene->numerics = chosen;
}

/* What would help, as the end of a message. */
static void advice(const motions *m, size_t bytes, char *text) {
  kz_numerics numerics;
  if (find_steps(m, &numerics))
    snprintf(text, bytes, "%d steps or more", (int)numerics.steps_per_period);
  else
    snprintf(text, bytes, "not even %d steps are enough: %s", (int)numerics.steps_per_period,
             m->lost >= LOST                    ? "slower starts, or weaker damping and drive"
             : m->numerics.precision == KZ_QUAD ? "wider cells"
                                                : "wider cells, or numerics.precision quad and basin.method direct");
}

static void describe_error(const motions *m, double error, size_t bytes, char *text) {
  if (error == DBL_MAX)
    snprintf(text, bytes, "diverge");
  else if (m->lost >= LOST)
    snprintf(text, bytes, "are off by up to %.2g rad after one drive period", error);
  else
    snprintf(text, bytes, "are off by up to %.2g rad after one drive period, where a cell is %.2g wide", error, m->cell);
}

static kz_status check(const motions *m) {
  const kz_step_trial classes = kz_try_steps(&m->pendulum, &m->numerics, m->fastest);
  const int worst = kz_worst_class(&classes);
  if (classes.error[worst] <= m->lost) return KZ_OK;
  char what[120], help[160];
  kz_scheme scheme;
  kz_scheme_row(m->numerics.scheme, &scheme);
  describe_error(m, classes.error[worst], sizeof what, what);
  advice(m, sizeof help, help);
  return kz_fail(KZ_REFUSED, "%s: %swith numerics.steps_per_period = %d of %s, motions at speeds from %.3g to %.3g %s; %s",
                 m->keys, m->where, (int)m->numerics.steps_per_period, scheme.name, classes.speed[worst],
                 classes.speed[worst + 1], what, help);
}

/* Without damping nothing is labelled. */
static kz_status check_basin(const kz_scene *scene) {
  kz_numerics fine;
  if (!scene->has_basin || !(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  const motions m = motions_of_basin(scene);
  if (isnan(scene->basin.accuracy)) KZ_TRY(check(&m));
  return scene->has_tradeoff || !isnan(scene->basin.accuracy) ? kz_reference_labels_numerics(&scene->basin, &m.pendulum, &fine)
                                                              : KZ_OK;
}

static kz_status check_attractors(const kz_scene *scene) {
  const motions m =
      motions_of(scene, kz_axis_fastest(&scene->attractors.velocity), "numerics.steps_per_period|attractors.velocity");
  return scene->has_attractors && m.pendulum.beta > 0 ? check(&m) : KZ_OK;
}

static kz_status check_orbit(const kz_scene *scene) {
  const double start = scene->orbit.velocity;
  motions m = motions_of(scene, isfinite(start) ? fabs(start) : 0, "numerics.steps_per_period|orbit.start|orbit");
  if (!scene->has_orbit || scene->orbit.model != KZ_PENDULUM) return KZ_OK;
  m.numerics.steps_per_period = (int32_t)kz_orbit_steps(scene);
  return check(&m);
}

/* The fastest start at any value of a sweep. */
static double fastest_of_sweep(const kz_scene *scene) {
  const double fastest = fmax(kz_axis_fastest(&scene->sweep.velocity), fabs(scene->sweep.start_velocity));
  return scene->has_basin ? fmax(fastest, kz_axis_fastest(&scene->basin.velocity)) : fastest;
}

static int64_t tried_values(const kz_scene *scene) {
  const int64_t affordable = SWEEP_STEPS / scene->numerics.steps_per_period;
  const int64_t n = affordable < 2 ? 2 : affordable < SWEEP_VALUES ? affordable : SWEEP_VALUES;
  return n < scene->sweep.values.count ? n : scene->sweep.values.count;
}

/* Motions at tried value i of n; false where that is no pendulum, or nothing is followed without damping. */
static bool motions_at(const kz_scene *scene, int64_t i, int64_t n, motions *m) {
  const kz_sweep_plan *plan = &scene->sweep;
  const double value = kz_sweep_value(plan, i * (plan->values.count - 1) / (n - 1));
  *m = motions_of(scene, fastest_of_sweep(scene), "numerics.steps_per_period|sweep");
  if (kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS)) hold_against_cells(&scene->basin, m);
  snprintf(m->where, sizeof m->where, "at %s = %.6g, ", kz_sweep_parameters[plan->parameter].name, value);
  const bool damped_alone = !kz_sweep_measures(plan, KZ_SWEEP_RELEASE_ANGLE) && !kz_sweep_measures(plan, KZ_SWEEP_STROBE);
  return kz_sweep_pendulum(scene, value, &m->pendulum) && (m->pendulum.beta > 0 || !damped_alone);
}

static kz_status check_sweep(const kz_scene *scene) {
  motions m;
  if (!scene->has_sweep) return KZ_OK;
  const int64_t n = tried_values(scene);
  for (int64_t i = 0; i < n; i++) /* the ends first: the largest error is usually at one of them */
    if (motions_at(scene, (n - i) % n, n, &m)) KZ_TRY(check(&m));
  return KZ_OK;
}

kz_status kz_steps_check(const kz_scene *scene) {
  KZ_TRY(check_basin(scene));
  KZ_TRY(check_attractors(scene));
  KZ_TRY(check_orbit(scene));
  return check_sweep(scene);
}

static void warn(const motions *m, const kz_step_trial *classes, FILE *summary) {
  char help[160];
  for (int c = 0; c < KZ_SPEED_CLASSES; c++)
    if (classes->error[c] > m->loose)
      fprintf(summary, "warning: %sat speeds from %.3g to %.3g one drive period is off by up to %.2g rad\n", m->where,
              classes->speed[c], classes->speed[c + 1], classes->error[c]);
  if (kz_worst_error(classes) <= m->loose) return;
  advice(m, sizeof help, help);
  fprintf(summary, "warning: to get below %.2g rad per period at every speed: numerics.steps_per_period: %s\n", m->loose, help);
}

void kz_steps_warn(const kz_scene *scene, double fastest, FILE *summary) {
  const motions m = motions_of(scene, fastest, "");
  const kz_step_trial classes = kz_try_steps(&m.pendulum, &m.numerics, m.fastest);
  warn(&m, &classes, summary);
}

double kz_steps_warn_basin(const kz_scene *scene, FILE *summary) {
  const motions m = motions_of_basin(scene);
  const kz_step_trial classes = kz_try_steps(&m.pendulum, &m.numerics, m.fastest);
  const double worst = kz_worst_error(&classes);
  kz_scheme scheme;
  kz_scheme_row(m.numerics.scheme, &scheme);
  fprintf(summary, "%s, %d steps a drive period", scheme.name, (int)m.numerics.steps_per_period);
  if (m.numerics.steps_per_period != scheme.default_steps)
    fprintf(summary, " (its own number is %d)", (int)scheme.default_steps);
  fprintf(summary, ": a period is off by at most %.2g rad, %.2g of a cell\n", worst, worst / m.cell);
  warn(&m, &classes, summary);
  return worst;
}

void kz_steps_warn_sweep(const kz_scene *scene, FILE *summary) {
  const int64_t n = tried_values(scene);
  double largest = 0;
  motions m, worst;
  kz_step_trial worst_trial;
  for (int64_t i = 0; i < n; i++) {
    if (!motions_at(scene, i, n, &m)) continue;
    const kz_step_trial classes = kz_try_steps(&m.pendulum, &m.numerics, m.fastest);
    if (kz_worst_error(&classes) <= largest) continue;
    largest = kz_worst_error(&classes);
    worst = m;
    worst_trial = classes;
  }
  if (largest > 0) warn(&worst, &worst_trial, summary);
}
