/* Whether the numerics can carry a scene: step doubling on a sample of every class of speeds. */
#include "kapitza/steps.h"

#include <float.h>
#include <math.h>

#include "kapitza/trial.h"

enum { DOUBLINGS = 8 }; /* of the scene's steps that are tried as advice */

/* rad, of one drive period: from LOOSE on a user is warned, from LOST on labels would be chance. */
static const double LOOSE = 1e-4, LOST = 0.1;

kz_step_trial kz_steps_try(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  kz_step_trial trial = {{0}, {0}};
  double top = fmax(fmax(fastest, 1.5), 2 * sqrt(fabs(pendulum->k) + fabs(pendulum->m)));
  for (int c = 1; c <= KZ_SPEED_CLASSES; c++) trial.speed[c] = ldexp(top, c - KZ_SPEED_CLASSES);
  kz_trial_step_errors(pendulum, numerics, KZ_SPEED_CLASSES, trial.speed, trial.error);
  return trial;
}

double kz_steps_worst(const kz_step_trial *trial) {
  double worst = 0;
  for (int c = 0; c < KZ_SPEED_CLASSES; c++) worst = fmax(worst, trial->error[c]);
  return worst;
}

/* Doubles the steps until every class is under LOOSE; false where that does not help, *steps: the last number tried. */
static bool enough_steps(const kz_scene *scene, double fastest, int32_t *steps) {
  kz_numerics numerics = scene->numerics;
  for (int i = 0; i < DOUBLINGS && numerics.steps_per_period <= INT32_MAX / 4; i++) {
    numerics.steps_per_period *= 2;
    *steps = numerics.steps_per_period;
    kz_step_trial trial = kz_steps_try(&scene->parameters.pendulum, &numerics, fastest);
    if (kz_steps_worst(&trial) <= LOOSE) return true;
  }
  return false;
}

/* The worst class. */
static int worst_class(const kz_step_trial *trial) {
  int worst = 0;
  for (int c = 1; c < KZ_SPEED_CLASSES; c++)
    if (trial->error[c] > trial->error[worst]) worst = c;
  return worst;
}

/* The fastest start of the scene's studies that label or search with the scene's numerics; negative where it has none. */
static double fastest_start(const kz_scene *scene) {
  double fastest = -1;
  if (scene->has_basin && isnan(scene->basin.accuracy))
    fastest = fmax(fabs(scene->basin.velocity.min), fabs(scene->basin.velocity.max));
  if (scene->has_attractors)
    fastest = fmax(fastest, fmax(fabs(scene->attractors.velocity.min), fabs(scene->attractors.velocity.max)));
  return fastest;
}

/* What would help, as the end of a message. */
static void advice(const kz_scene *scene, double fastest, size_t bytes, char *text) {
  int32_t steps = scene->numerics.steps_per_period;
  if (enough_steps(scene, fastest, &steps))
    snprintf(text, bytes, "%d steps or more", (int)steps);
  else
    snprintf(text, bytes, "not even %d steps are enough: slower starts, or weaker damping and drive", (int)steps);
}

static void describe_error(double error, size_t bytes, char *text) {
  if (error < DBL_MAX)
    snprintf(text, bytes, "are off by %.2g rad after one drive period", error);
  else
    snprintf(text, bytes, "diverge");
}

static kz_status check_pendulum(const kz_scene *scene, double fastest) {
  if (fastest < 0 || !(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  kz_step_trial trial = kz_steps_try(&scene->parameters.pendulum, &scene->numerics, fastest);
  int worst = worst_class(&trial);
  if (trial.error[worst] <= LOST) return KZ_OK;
  char what[80], help[160];
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  describe_error(trial.error[worst], sizeof what, what);
  advice(scene, fastest, sizeof help, help);
  return kz_fail(KZ_REFUSED, "numerics.steps_per_period: with %d steps of %s, motions at speeds from %.3g to %.3g %s; %s",
                 (int)scene->numerics.steps_per_period, scheme.name, trial.speed[worst], trial.speed[worst + 1], what, help);
}

/* A sweep at both ends of its values. */
static kz_status check_sweep(const kz_scene *scene) {
  const kz_axis *velocity = &scene->sweep.velocity;
  const double ends[] = {scene->sweep.values.min, scene->sweep.values.max};
  for (int i = 0; i < 2; i++) {
    kz_scene at = *scene;
    if (kz_sweep_pendulum(scene, ends[i], &at.parameters.pendulum))
      KZ_TRY(check_pendulum(&at, fmax(fabs(velocity->min), fabs(velocity->max))));
  }
  return KZ_OK;
}

kz_status kz_steps_check(const kz_scene *scene) {
  KZ_TRY(check_pendulum(scene, fastest_start(scene)));
  return scene->has_sweep ? check_sweep(scene) : KZ_OK;
}

static void warn_steps(const kz_scene *scene, double fastest, const kz_step_trial *trial, FILE *summary) {
  char help[160];
  bool loose = false;
  for (int c = 0; c < KZ_SPEED_CLASSES; c++) {
    if (trial->error[c] <= LOOSE) continue;
    loose = true;
    fprintf(summary, "warning: at speeds from %.3g to %.3g one drive period is off by %.2g rad\n", trial->speed[c],
            trial->speed[c + 1], trial->error[c]);
  }
  if (!loose) return;
  advice(scene, fastest, sizeof help, help);
  fprintf(summary, "warning: to get below %g rad per period at every speed: numerics.steps_per_period: %s\n", LOOSE, help);
}

double kz_steps_warn(const kz_scene *scene, double fastest, int64_t max_periods, FILE *summary) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  kz_step_trial trial = kz_steps_try(pendulum, &scene->numerics, fastest);
  warn_steps(scene, fastest, &trial, summary);
  double lifetime = 1 / (2 * M_PI * pendulum->beta); /* periods in which areas shrink by e */
  if ((double)max_periods < lifetime)
    fprintf(summary,
            "warning: damping %g needs %.3g drive periods to shrink areas by e: hardly anything settles within %lld; more "
            "max_periods or more damping\n",
            pendulum->beta, lifetime, (long long)max_periods);
  return kz_steps_worst(&trial);
}

void kz_steps_warn_table(double defect, FILE *summary) {
  if (defect <= LOOSE) return;
  fprintf(summary,
          "warning: one drive period of the map table is off by %.2g rad; more nodes (basin.icm), a higher interpolation, or "
          "method direct\n",
          defect);
}
