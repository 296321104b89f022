/* Study `orbit`: its group in the file, its line for people. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "orbit.h"

static const char *const GROUP = "orbit";

/* Every `stride`-th value, count of them, in a new array. */
static double *every(const double *from, int64_t stride, int64_t count) {
  double *to = kz_malloc((size_t)count * sizeof *to);
  for (int64_t i = 0; i < count; i++) to[i] = from[i * stride];
  return to;
}

/* unit * (0, 1, 2, ...) / parts */
static double *ramp(double unit, int64_t parts, int64_t count) {
  double *to = kz_malloc((size_t)count * sizeof *to);
  for (int64_t i = 0; i < count; i++) to[i] = unit * (double)i / (double)parts;
  return to;
}

/* The pivot's places along one axis: 0 = aside, 1 = height. */
static double *pivot(const kz_parameters *parameters, int axis, int64_t samples, int64_t count) {
  double *to = kz_malloc((size_t)count * sizeof *to), place[2];
  for (int64_t i = 0; i < count; i++) {
    kz_pivot_at(parameters, (double)(i % samples) / (double)samples, place);
    to[i] = place[axis];
  }
  return to;
}

static bool moves_aside(const kz_pendulum *p) {
  for (int j = 0; j < p->harmonics; j++)
    if (p->horizontal[j][0] != 0 || p->horizontal[j][1] != 0) return true;
  return false;
}

/* Writes one array and frees it. */
static kz_status put(kz_store *store, const char *name, bool dimension, int64_t count, double *values) {
  kz_status status =
      dimension ? kz_store_dimension(store, GROUP, name, count, values) : kz_store_variable(store, GROUP, name, values);
  free(values);
  return status;
}

static kz_status write_series(const kz_orbit *orbit, kz_store *store) {
  const kz_motion *motion = &orbit->motion;
  int64_t samples = orbit->plan->samples_per_period, stride = motion->samples / samples, n = motion->periods * samples + 1;
  KZ_TRY(put(store, "time", true, n, ramp(2 * M_PI, samples, n)));
  KZ_TRY(put(store, "theta", false, n, every(motion->theta, stride, n)));
  KZ_TRY(put(store, "velocity", false, n, every(motion->velocity, stride, n)));
  KZ_TRY(put(store, "pivot", false, n, pivot(orbit->parameters, 1, samples, n)));
  if (moves_aside(&orbit->pendulum)) KZ_TRY(put(store, "pivot_aside", false, n, pivot(orbit->parameters, 0, samples, n)));
  n = motion->periods + 1;
  KZ_TRY(put(store, "strobe_time", true, n, ramp(2 * M_PI, 1, n)));
  KZ_TRY(put(store, "strobe_theta", false, n, every(motion->theta, motion->samples, n)));
  return put(store, "strobe_velocity", false, n, every(motion->velocity, motion->samples, n));
}

/* What the lines are of. */
static kz_status write_quantity(const kz_orbit_features *features, kz_store *store) {
  KZ_TRY(kz_store_text(store, GROUP, "line_quantity", features->chaotic ? "velocity" : "angle"));
  return kz_store_text(store, GROUP, "line_units", features->chaotic ? "1" : "rad");
}

static kz_status write_features(const kz_orbit_features *features, kz_store *store) {
  const double *turning = &features->turning->time; /* pairs (time, angle) */
  int64_t n = features->n_turning;
  KZ_TRY(put(store, "maximum_time", true, n, every(turning, 2, n)));
  KZ_TRY(put(store, "maximum_angle", false, n, every(turning + 1, 2, n)));
  KZ_TRY(put(store, "line_frequency", true, features->n_lines, ramp(1, features->record_periods, features->n_lines)));
  KZ_TRY(write_quantity(features, store));
  KZ_TRY(kz_store_variable(store, GROUP, "line_amplitude", features->amplitude));
  return kz_store_variable(store, GROUP, "line_phase", features->phase);
}

static kz_status write_attributes(const kz_orbit *orbit, kz_store *store) {
  static const char *const MODEL[] = {"pendulum", "mathieu", "effective"};
  const kz_orbit_features *p = &orbit->features;
  const struct {
    const char *name;
    int64_t value;
  } integers[] = {{"period", p->period},          {"winding", p->winding}, {"centre", p->centre},
                  {"dominant_line", p->dominant}, {"closed", p->closed},   {"symmetric", p->symmetric}};
  for (size_t i = 0; i < sizeof integers / sizeof integers[0]; i++)
    KZ_TRY(kz_store_integer(store, GROUP, integers[i].name, integers[i].value));
  KZ_TRY(kz_store_text(store, GROUP, "name", p->name));
  KZ_TRY(kz_store_text(store, GROUP, "model", MODEL[orbit->plan->model]));
  if (orbit->plan->model != KZ_PENDULUM) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "lyapunov", orbit->lyapunov));
  KZ_TRY(kz_store_real(store, GROUP, "lyapunov_error", orbit->lyapunov_error));
  if (orbit->settles_on[0]) KZ_TRY(kz_store_text(store, GROUP, "settles_on", orbit->settles_on));
  if (!p->closed) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "multiplier_re", orbit->cycle.re[0]));
  return kz_store_real(store, GROUP, "multiplier_im", orbit->cycle.im[0]);
}

static void print_open(const kz_orbit *orbit, FILE *summary) {
  const kz_orbit_features *p = &orbit->features;
  fprintf(summary, "orbit: %sopen record of %" PRId64 " period%s", p->chaotic ? "chaotic, " : "", orbit->motion.periods,
          orbit->motion.periods > 1 ? "s" : "");
  if (p->period > 0)
    fprintf(summary, "; its spectrum has period %" PRId64 " (%s)", p->period, p->name);
  else if (!p->chaotic)
    fprintf(summary, "; its spectrum shows no period");
  if (orbit->settles_on[0] && strcmp(orbit->settles_on, p->name) != 0)
    fprintf(summary, "; it settles on %s", orbit->settles_on);
}

void kz_orbit_print(const kz_orbit *orbit, FILE *summary) {
  const kz_orbit_features *p = &orbit->features;
  if (p->closed)
    fprintf(summary, "orbit: %s, closes after %" PRId64 " period%s", p->name, p->period, p->period > 1 ? "s" : "");
  else
    print_open(orbit, summary);
  if (p->dominant > 0)
    fprintf(summary, "; largest line%s %.6g rad%s at %" PRId64 "/%" PRId64 " of the drive frequency",
            p->chaotic ? " of the velocity" : "", p->amplitude[p->dominant], p->chaotic ? " per drive radian" : "", p->dominant,
            p->record_periods);
  if (!p->closed && isfinite(orbit->lyapunov))
    fprintf(summary, "; largest Lyapunov exponent %.4f +- %.4f per period", orbit->lyapunov, orbit->lyapunov_error);
  fprintf(summary, "\n");
}

kz_status kz_orbit_write(const kz_orbit *orbit, kz_store *store) {
  KZ_TRY(write_series(orbit, store));
  KZ_TRY(write_features(&orbit->features, store));
  return write_attributes(orbit, store);
}
