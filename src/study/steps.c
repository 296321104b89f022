/* Whether the numerics can carry a scene: step doubling on a sample of every class of speeds. */
#include "kapitza/steps.h"

#include <float.h>
#include <math.h>

#include "cells.h"
#include "judge.h"
#include "kapitza/trial.h"
#include "sweep.h"

enum {
  DOUBLINGS = 8,       /* of the steps that are tried as advice */
  MOST_STEPS = 100000, /* that a scene can ask for */
  SWEEP_VALUES = 17,   /* of a sweep that are tried, fewer where they take many steps */
  SWEEP_STEPS = 20000  /* that those trials take together */
};

/* Classes of speeds: the fastest half of all speeds, half of those, and so on; class 0 is what is left. */
enum { CLASSES = 8 };

typedef struct {
  double speed[CLASSES + 1]; /* rad per drive radian, from 0 */
  double error[CLASSES];     /* rad, of one drive period; DBL_MAX = diverges */
} step_trial;

/* rad, of one drive period: from LOOSE on a user is warned, from LOST on labels would be chance. */
static const double LOOSE = 1e-4, LOST = 0.1;

/* Step doubling on a sample of the speeds up to `fastest`, and those that rotation and fall bring. */
static step_trial try_steps(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  step_trial trial = {{0}, {0}};
  double top = fmax(fmax(fastest, 1.5), 2 * sqrt(fabs(pendulum->k) + fabs(pendulum->m)));
  for (int c = 1; c <= CLASSES; c++) trial.speed[c] = ldexp(top, c - CLASSES);
  kz_trial_step_errors(pendulum, numerics, CLASSES, trial.speed, trial.error);
  return trial;
}

static int worst_class(const step_trial *trial) {
  int worst = 0;
  for (int c = 1; c < CLASSES; c++)
    if (trial->error[c] > trial->error[worst]) worst = c;
  return worst;
}

static double worst_error(const step_trial *trial) {
  return trial->error[worst_class(trial)];
}

bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most, kz_numerics *numerics) {
  step_trial trial = try_steps(pendulum, numerics, fastest);
  for (int worst; worst = worst_class(&trial), trial.error[worst] > tolerance;) {
    do { /* the worst class alone: where nothing helps, that is soon known */
      if (numerics->steps_per_period > most / 2) return false;
      numerics->steps_per_period *= 2;
      kz_trial_step_errors(pendulum, numerics, 1, trial.speed + worst, trial.error + worst);
    } while (trial.error[worst] > tolerance);
    trial = try_steps(pendulum, numerics, fastest);
  }
  return true;
}

bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  const step_trial trial = try_steps(pendulum, numerics, fastest);
  return worst_error(&trial) <= LOST;
}

/* Motions of one study: what they are tried with, and the keys that a user could change. */
typedef struct {
  kz_pendulum pendulum;
  kz_numerics numerics;
  double fastest;   /* start, rad per drive radian */
  const char *keys; /* "KEY|KEY" */
  char where[96];   /* "at m = 0.3, ", or "" */
} motions;

static motions motions_of(const kz_scene *scene, double fastest, const char *keys) {
  return (motions){scene->parameters.pendulum, scene->numerics, fastest, keys, ""};
}

/* What would help, as the end of a message. */
static void advice(const motions *m, size_t bytes, char *text) {
  kz_numerics numerics = m->numerics;
  const int32_t most = (int32_t)fmin(MOST_STEPS, ldexp(numerics.steps_per_period, DOUBLINGS));
  if (kz_steps_enough(&m->pendulum, m->fastest, LOOSE, most, &numerics))
    snprintf(text, bytes, "%d steps or more", (int)numerics.steps_per_period);
  else
    snprintf(text, bytes, "not even %d steps are enough: slower starts, or weaker damping and drive",
             (int)numerics.steps_per_period);
}

static void describe_error(double error, size_t bytes, char *text) {
  if (error < DBL_MAX)
    snprintf(text, bytes, "are off by %.2g rad after one drive period", error);
  else
    snprintf(text, bytes, "diverge");
}

static kz_status check(const motions *m) {
  const step_trial trial = try_steps(&m->pendulum, &m->numerics, m->fastest);
  const int worst = worst_class(&trial);
  if (trial.error[worst] <= LOST) return KZ_OK;
  char what[80], help[160];
  kz_scheme scheme;
  kz_scheme_row(m->numerics.scheme, &scheme);
  describe_error(trial.error[worst], sizeof what, what);
  advice(m, sizeof help, help);
  return kz_fail(KZ_REFUSED, "%s: %swith numerics.steps_per_period = %d of %s, motions at speeds from %.3g to %.3g %s; %s",
                 m->keys, m->where, (int)m->numerics.steps_per_period, scheme.name, trial.speed[worst], trial.speed[worst + 1],
                 what, help);
}

/* Without damping nothing is labelled. */
static kz_status check_basin(const kz_scene *scene) {
  const motions m = motions_of(scene, kz_axis_fastest(&scene->basin.velocity), "numerics.steps_per_period|basin.velocity");
  kz_numerics fine;
  if (!scene->has_basin || !(m.pendulum.beta > 0)) return KZ_OK;
  if (isnan(scene->basin.accuracy)) KZ_TRY(check(&m));
  return scene->has_tradeoff || !isnan(scene->basin.accuracy) ? kz_judge_numerics(&scene->basin, &m.pendulum, &fine) : KZ_OK;
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
  snprintf(m->where, sizeof m->where, "at %s = %.6g, ", kz_sweep_parameters[plan->parameter].name, value);
  const bool damped_alone = !kz_sweep_measures(plan, KZ_SWEEP_RELEASE_ANGLE) && !kz_sweep_measures(plan, KZ_SWEEP_STROBE);
  return kz_sweep_pendulum(scene, value, &m->pendulum) && (m->pendulum.beta > 0 || !damped_alone);
}

static kz_status check_sweep(const kz_scene *scene) {
  motions m;
  if (!scene->has_sweep) return KZ_OK;
  const int64_t n = tried_values(scene);
  for (int64_t i = 0; i < n; i++) /* the ends first: one of them is hardest as a rule */
    if (motions_at(scene, (n - i) % n, n, &m)) KZ_TRY(check(&m));
  return KZ_OK;
}

kz_status kz_steps_check(const kz_scene *scene) {
  KZ_TRY(check_basin(scene));
  KZ_TRY(check_attractors(scene));
  KZ_TRY(check_orbit(scene));
  return check_sweep(scene);
}

static double warn(const motions *m, FILE *summary) {
  const step_trial trial = try_steps(&m->pendulum, &m->numerics, m->fastest);
  const double worst = worst_error(&trial);
  char help[160];
  for (int c = 0; c < CLASSES; c++)
    if (trial.error[c] > LOOSE)
      fprintf(summary, "warning: %sat speeds from %.3g to %.3g one drive period is off by %.2g rad\n", m->where, trial.speed[c],
              trial.speed[c + 1], trial.error[c]);
  if (worst <= LOOSE) return worst;
  advice(m, sizeof help, help);
  fprintf(summary, "warning: to get below %g rad per period at every speed: numerics.steps_per_period: %s\n", LOOSE, help);
  return worst;
}

double kz_steps_warn(const kz_scene *scene, double fastest, FILE *summary) {
  const motions m = motions_of(scene, fastest, "");
  return warn(&m, summary);
}

void kz_steps_warn_sweep(const kz_scene *scene, FILE *summary) {
  const int64_t n = tried_values(scene);
  double largest = LOOSE;
  motions m, worst;
  for (int64_t i = 0; i < n; i++) {
    if (!motions_at(scene, i, n, &m)) continue;
    const step_trial trial = try_steps(&m.pendulum, &m.numerics, m.fastest);
    if (worst_error(&trial) <= largest) continue;
    largest = worst_error(&trial);
    worst = m;
  }
  if (largest > LOOSE) warn(&worst, summary);
}

void kz_steps_warn_table(double defect, FILE *summary) {
  if (defect <= LOOSE) return;
  fprintf(summary,
          "warning: one drive period of the map table is off by %.2g rad; more nodes (basin.icm), a higher interpolation, or "
          "method direct\n",
          defect);
}
