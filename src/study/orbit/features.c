/* Features of an orbit: centre, period, winding, lines, turning points. */
#include "kapitza/dynamics_cycles.h"
#include "orbit.h"

/* Lines up to this many drive frequencies. */
enum { TOP_FREQUENCY = 8 };

/* Net turns a period: whole turns of a cycle, the fitted rate of an open record that turns at least once. */
static double rotation_of(const kz_orbit_motion *motion, const kz_record *record) {
  if (record->closed) {
    double advance = motion->theta[record->periods * record->samples_per_period] - motion->theta[0];
    return (double)llrint(advance / (2 * M_PI)) / (double)record->periods;
  }
  double rotation = kz_spectrum_rotation(record, motion->theta);
  return fabs(rotation) * (double)record->periods < 1 ? 0 : rotation;
}

static kz_status make_lines(const kz_orbit_motion *motion, const kz_record *record, kz_orbit_features *features) {
  const size_t n = (size_t)(TOP_FREQUENCY * record->periods) + 1;
  features->n_lines = (int64_t)n;
  features->record_periods = record->periods;
  features->amplitude = kz_malloc(n * sizeof(double));
  features->phase = kz_malloc(n * sizeof(double));
  KZ_TRY(kz_spectrum_lines(record, motion->theta, features->n_lines, features->amplitude, features->phase));
  features->dominant = kz_spectrum_dominant(features->n_lines, features->amplitude);
  features->period = kz_spectrum_period(record, features->n_lines, features->amplitude);
  features->symmetric = record->closed && kz_spectrum_symmetric(record, features->n_lines, features->amplitude);
  return KZ_OK;
}

/* The lines of the velocity instead of those of the angle. */
static kz_status take_velocity(const kz_orbit_motion *motion, kz_orbit_features *features) {
  const kz_record record = {.periods = motion->periods, .samples_per_period = motion->samples, .velocity = true};
  KZ_TRY(kz_spectrum_lines(&record, motion->velocity, features->n_lines, features->amplitude, features->phase));
  features->dominant = kz_spectrum_dominant(features->n_lines, features->amplitude);
  return KZ_OK;
}

static void make_turning(const kz_orbit_motion *motion, kz_orbit_features *features) {
  int64_t n = motion->periods * motion->samples + 1;
  features->turning = kz_malloc((size_t)n * sizeof *features->turning);
  double step = 2 * M_PI / (double)motion->samples;
  features->n_turning = kz_turning_points(n, step, motion->theta, motion->velocity, features->turning);
  for (int64_t i = 0; i < features->n_turning; i++) features->turning[i].angle -= features->origin;
}

kz_status kz_orbit_features_make(kz_orbit *orbit) {
  const kz_orbit_motion *motion = &orbit->motion;
  const int64_t period = orbit->cycle.period;
  kz_orbit_features *features = &orbit->features;
  *features = (kz_orbit_features){.closed = period > 0};
  kz_record record = {
      .periods = period > 0 ? period : motion->periods, .samples_per_period = motion->samples, .closed = period > 0};
  record.rotation = rotation_of(motion, &record);
  features->centre =
      kz_centre_of(record.rotation != 0, record.periods * motion->samples, motion->theta, &features->origin);
  record.centre = features->origin;
  KZ_TRY(make_lines(motion, &record, features));
  if (record.closed && features->period != period)
    return kz_fail(
        KZ_REFUSED,
        "orbit: by its strobe points the cycle has period %lld, by its spectral lines %lld; choose another cycle",
        (long long)period, (long long)features->period);
  features->chaotic = orbit->parting && features->period == 0;
  if (features->chaotic) KZ_TRY(take_velocity(motion, features));
  int64_t span = features->period > 0 ? features->period : record.periods;
  features->winding = llrint(record.rotation * (double)span);
  if (features->period > 0 || features->chaotic)
    kz_orbit_name(features->period, features->chaotic ? 0 : features->winding, features->centre, features->name);
  make_turning(motion, features);
  return KZ_OK;
}
