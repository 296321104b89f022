#include "resolve.h"

#include <math.h>

#include "cells.h"
#include "processed.h"

/* Samples a period that turning points and spectra need, however few are written. */
enum { LEAST_SAMPLES = 96 };

kz_motions kz_motions_of_basin(const kz_scene *scene) {
  kz_motions motions =
      kz_motions_of(scene, kz_axis_fastest(&scene->basin.velocity), "numerics.steps_per_period|basin.velocity");
  if (scene->basin.method == KZ_METHOD_EXACT) /* errors are followed: they need not be small beside a cell */
    motions.cell = kz_cell_size(&scene->basin);
  else
    kz_motions_label_cells(&scene->basin, &motions);
  return motions;
}

/* The scheme's own number of steps, or more for small cells; `enough`: or more for any cells. */
static void choose_steps(kz_scene *scene, bool enough) {
  kz_numerics chosen;
  scene->numerics.steps_per_period = kz_scheme_at(scene->numerics.scheme).default_steps;
  if (!scene->has_basin || !isnan(scene->basin.accuracy) || !(scene->parameters.pendulum.beta > 0)) return;
  const kz_motions motions = kz_motions_of_basin(scene);
  if ((enough || motions.refuse_above < KZ_STEPS_REFUSED) && kz_motions_find_steps(&motions, &chosen)) scene->numerics = chosen;
}

void kz_numerics_resolve(kz_scene *scene) {
  const kz_numerics_keys *asked = &scene->asked;
  const bool processed = kz_is_processed(asked->scheme);
  if (processed && kz_processed_choose(scene)) return;
  scene->numerics = (kz_numerics){.scheme = processed ? kz_scheme_find("split6") : asked->scheme,
                                  .steps_per_period = asked->steps_per_period};
  if (processed || asked->steps_per_period == KZ_AUTO) choose_steps(scene, processed);
}

static double multiple(double unit, double least) {
  return unit * ceil(least / unit);
}

/* Rad per drive radian: the fastest swing about an equilibrium. */
static double swing(const kz_pendulum *p) {
  return sqrt(kz_stiffness(p));
}

static double samples_of(const kz_scene *scene) {
  return multiple((double)scene->orbit.samples_per_period, LEAST_SAMPLES * fmax(1, swing(&scene->parameters.pendulum)));
}

/* Within a period the processed splitting shows nothing. */
static int32_t orbit_scheme(const kz_scene *scene) {
  return kz_is_processed(scene->asked.scheme) ? kz_scheme_find("split6") : scene->asked.scheme;
}

double kz_orbit_steps(const kz_scene *scene) {
  const double start = isfinite(scene->orbit.velocity) ? fabs(scene->orbit.velocity) : 0;
  const double speed = 1 + 2 * swing(&scene->parameters.pendulum) + start;
  const int32_t steps = kz_scheme_at(orbit_scheme(scene)).default_steps;
  const double asked = scene->asked.steps_per_period == KZ_AUTO ? steps : scene->asked.steps_per_period;
  return multiple(samples_of(scene), fmax(asked, steps * speed / 2));
}

kz_numerics kz_orbit_numerics(const kz_scene *scene) {
  return (kz_numerics){.scheme = orbit_scheme(scene), .steps_per_period = (int32_t)kz_orbit_steps(scene)};
}

int64_t kz_orbit_samples(const kz_scene *scene) {
  return (int64_t)samples_of(scene);
}
