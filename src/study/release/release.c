/* The release of a scene: from its keys to kz_release, to the dynamics and to the file. */
#include "release.h"

static bool release_has(double value) {
  return !isnan(value) && value != 0;
}

/* The phase as written; 0 for whole turns, such as 360 degrees, which no other double is. */
static double phase_of(double written) {
  const double turns = rint(written / (2 * M_PI));
  return !release_has(written) || fabs(written - turns * (2 * M_PI)) < 1e-24 ? 0 : written;
}

/* A ramp of the drive is in units of m, which it ends at. */
static kz_release release_of(const kz_scene *scene, const kz_ramp_plan *ramp, const kz_pendulum *pendulum) {
  const double phase = scene->has_basin ? phase_of(scene->release->start_phase) : 0;
  kz_release release = {.phase = phase, .damping = pendulum->beta, .drive = 1};
  if (!scene->has_ramp || !release_has(ramp->periods)) return release;
  release.periods = ramp->periods;
  release.smooth = ramp->shape == KZ_RAMP_SMOOTH;
  if (ramp->key == KZ_RAMP_DAMPING)
    release.damping = ramp->from;
  else
    release.drive = ramp->from / pendulum->m;
  return release;
}

kz_release kz_release_of(const kz_scene *scene, const kz_pendulum *pendulum) {
  return release_of(scene, scene->ramp, pendulum);
}

bool kz_release_is_same(const kz_release *a, const kz_release *b) {
  const int64_t strobes = kz_release_strobes(a);
  if (strobes == 0 || kz_release_strobes(b) != strobes) return kz_release_strobes(b) == strobes;
  return a->phase == b->phase && a->periods == b->periods && a->damping == b->damping && a->drive == b->drive &&
         a->smooth == b->smooth;
}

void kz_release_begin(const kz_scene *scene, const kz_pendulum *pendulum, const double *swept, kz_dynamics *dynamics) {
  kz_ramp_plan ramp = *scene->ramp;
  const kz_sweep_parameter *parameter = swept ? kz_sweep_parameter_at(scene->sweep->parameter) : NULL;
  if (parameter && parameter->plan == offsetof(kz_scene, ramp)) *(double *)((char *)&ramp + parameter->offset) = *swept;
  const kz_release release = release_of(scene, &ramp, pendulum);
  kz_dynamics_set_release(dynamics, &release);
}

kz_status kz_release_describe(const kz_scene *scene, kz_store *store) {
  const double phase = scene->release->start_phase;
  return isnan(phase) ? KZ_OK : kz_store_real(store, "/pendulum", "start_phase", phase_of(phase));
}

kz_status kz_ramp_describe(const kz_scene *scene, kz_store *store) {
  const kz_ramp_plan *ramp = scene->ramp;
  const kz_release r = kz_release_of(scene, &scene->parameters.pendulum);
  const bool of_drive = ramp->key == KZ_RAMP_DRIVE;
  if (!(r.periods > 0)) return KZ_OK;
  KZ_TRY(kz_store_text(store, "/pendulum", "ramp_key", of_drive ? "drive_amplitude" : "damping"));
  KZ_TRY(kz_store_text(store, "/pendulum", "ramp_shape", r.smooth ? "smooth" : "linear"));
  KZ_TRY(kz_store_real(store, "/pendulum", "ramp_periods", r.periods));
  KZ_TRY(kz_store_real(store, "/pendulum", "ramp_from", ramp->from));
  return of_drive ? kz_store_real(store, "/pendulum", "ramp_strength", r.drive) : KZ_OK;
}
