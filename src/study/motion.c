/* Motions of the three models behind one door. */
#include "motion.h"

#include <math.h>
#include <stdlib.h>

/* Samples a period that turning points and spectra need, whatever the scene wants to see. */
enum { LEAST_SAMPLES = 96 };
/* Periods of a simpler model that are skipped at once. */
enum { CHUNK = 1024 };

static double multiple(double unit, double least) {
  return unit * ceil(least / unit);
}

/* Rad per drive radian: the fastest swing about an equilibrium. */
static double swing(const kz_pendulum *p) {
  return sqrt(fabs(p->k) + fabs(p->m));
}

static double samples_of(const kz_scene *scene) {
  return multiple((double)scene->orbit.samples_per_period, LEAST_SAMPLES * fmax(1, swing(&scene->parameters.pendulum)));
}

double kz_orbit_steps(const kz_scene *scene) {
  const double start = isfinite(scene->orbit.velocity) ? fabs(scene->orbit.velocity) : 0;
  const double speed = 1 + 2 * swing(&scene->parameters.pendulum) + start;
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  return multiple(samples_of(scene), fmax(scene->numerics.steps_per_period, scheme.default_steps * speed / 2));
}

kz_status kz_mover_make(const kz_scene *scene, kz_mover *mover) {
  const kz_orbit_plan *orbit = &scene->orbit;
  const kz_pendulum *p = &scene->parameters.pendulum;
  bool inverted = orbit->model == KZ_MATHIEU && orbit->about == KZ_ABOUT_INVERTED;
  *mover = (kz_mover){.model = orbit->model, .pendulum = *p, .samples = (int64_t)samples_of(scene)};
  if (inverted) mover->pendulum = (kz_pendulum){-p->k, p->beta, -p->m};
  if (inverted) mover->origin = M_PI;
  if (mover->model != KZ_PENDULUM) return KZ_OK;
  mover->numerics = scene->numerics;
  mover->numerics.steps_per_period = (int32_t)kz_orbit_steps(scene);
  if (orbit->closed && mover->numerics.precision == KZ_SINGLE) mover->numerics.precision = KZ_DOUBLE;
  mover->plan = kz_plan_create(p, &mover->numerics);
  return mover->plan ? KZ_OK : kz_fail(KZ_FAILED, "out of memory for the tables of an orbit");
}

void kz_mover_free(kz_mover *mover) {
  if (mover->plan) kz_plan_free(mover->plan);
  mover->plan = NULL;
}

/* Up to CHUNK periods of a simpler model. */
static void skip_chunk(const kz_mover *mover, int64_t periods, kz_state *state) {
  double theta[CHUNK + 1], velocity[CHUNK + 1];
  kz_sample_model(mover->model, &mover->pendulum, periods, 1, state->theta - mover->origin, state->velocity, theta, velocity);
  *state = (kz_state){theta[periods] + mover->origin, velocity[periods]};
}

void kz_mover_skip(const kz_mover *mover, int64_t periods, kz_state *state) {
  int64_t turns = 0;
  if (mover->plan) kz_advance(mover->plan, 1, periods, &state->theta, &state->velocity, &turns);
  for (int64_t done = 0; !mover->plan && done < periods; done += CHUNK)
    skip_chunk(mover, periods - done < CHUNK ? periods - done : CHUNK, state);
}

static kz_status check_range(const kz_motion *motion) {
  for (int64_t i = 0; i <= motion->periods * motion->samples; i++) {
    if (isfinite(motion->theta[i]) && isfinite(motion->velocity[i])) continue;
    return kz_fail(KZ_FAILED, "orbit: the motion leaves the range of numbers in period %lld; fewer periods or a smaller start",
                   (long long)(i / motion->samples));
  }
  return KZ_OK;
}

kz_status kz_mover_record(const kz_mover *mover, int64_t periods, kz_state start, kz_motion *motion) {
  size_t n = (size_t)(periods * mover->samples) + 1;
  *motion = (kz_motion){periods, mover->samples, malloc(n * sizeof(double)), malloc(n * sizeof(double))};
  if (!motion->theta || !motion->velocity)
    return kz_fail(KZ_FAILED, "out of memory for an orbit of %lld periods", (long long)periods);
  if (mover->plan) {
    kz_sample(mover->plan, periods, mover->samples, start.theta, start.velocity, motion->theta, motion->velocity);
  } else {
    kz_sample_model(mover->model, &mover->pendulum, periods, mover->samples, start.theta - mover->origin, start.velocity,
                    motion->theta, motion->velocity);
    for (size_t i = 0; i < n; i++) motion->theta[i] += mover->origin;
  }
  return check_range(motion);
}

void kz_motion_free(kz_motion *motion) {
  free(motion->theta);
  free(motion->velocity);
  motion->theta = motion->velocity = NULL;
}
