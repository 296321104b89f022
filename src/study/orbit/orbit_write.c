/* Study `orbit`: its group in the file, its line for people. */
#include <inttypes.h>

#include "orbit.h"

static const char *const GROUP = "orbit";

/* The pivot's place along an axis, 0 = aside, 1 = height, at a phase of the drive (rad). */
static double orbit_write_pivot(const kz_parameters *parameters, int axis, double phase) {
  double place[2];
  kz_pivot_at(parameters, phase, place);
  return place[axis];
}

static bool moves_aside(const kz_pendulum *p) {
  for (int j = 0; j < p->harmonics; j++)
    if (p->horizontal[j][0] != 0 || p->horizontal[j][1] != 0) return true;
  return false;
}

#define SCALE(name, n, expression) KZ_SCALE(store, GROUP, name, n, expression)
#define COLUMN(name, n, expression) KZ_COLUMN(store, GROUP, name, n, double, expression)

static kz_status write_series(const kz_orbit *orbit, kz_store *store) {
  const kz_orbit_motion *motion = &orbit->motion;
  const kz_parameters *parameters = &orbit->scene->parameters;
  const int64_t samples = orbit->scene->orbit->samples_per_period, stride = motion->samples / samples;
  const int64_t n = motion->periods * samples + 1, strobes = motion->periods + 1;
  SCALE("time", n, 2 * M_PI * (double)i / (double)samples);
  COLUMN("theta", n, motion->theta[i * stride]);
  COLUMN("velocity", n, motion->velocity[i * stride]);
  COLUMN("pivot", n, orbit_write_pivot(parameters, 1, 2 * M_PI * (double)(i % samples) / (double)samples));
  if (moves_aside(&parameters->pendulum))
    COLUMN("pivot_aside", n, orbit_write_pivot(parameters, 0, 2 * M_PI * (double)(i % samples) / (double)samples));
  if (orbit->model.kind == KZ_EFFECTIVE)
    COLUMN("xi", n,
           -parameters->pendulum.m * sin(motion->theta[i * stride]) *
               cos(2 * M_PI * (double)(i % samples) / (double)samples));
  SCALE("strobe_time", strobes, 2 * M_PI * (double)i);
  COLUMN("strobe_theta", strobes, motion->theta[i * motion->samples]);
  COLUMN("strobe_velocity", strobes, motion->velocity[i * motion->samples]);
  return KZ_OK;
}

static kz_status write_features(const kz_orbit_features *features, kz_store *store) {
  SCALE("maximum_time", features->n_turning, features->turning[i].time);
  COLUMN("maximum_angle", features->n_turning, features->turning[i].angle);
  SCALE("line_frequency", features->n_lines, (double)i / (double)features->record_periods);
  KZ_TRY(kz_store_text(store, GROUP, "line_quantity", features->chaotic ? "velocity" : "angle"));
  KZ_TRY(kz_store_text(store, GROUP, "line_units", features->chaotic ? "1" : "rad"));
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
  KZ_TRY(kz_store_text(store, GROUP, "model", MODEL[orbit->model.kind]));
  if (orbit->model.kind != KZ_PENDULUM) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "lyapunov", orbit->lyapunov));
  KZ_TRY(kz_store_real(store, GROUP, "lyapunov_error", orbit->lyapunov_error));
  if (orbit->settles_on[0]) KZ_TRY(kz_store_text(store, GROUP, "settles_on", orbit->settles_on));
  if (!p->closed) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "multiplier_re", orbit->cycle.row.multiplier_re[0]));
  return kz_store_real(store, GROUP, "multiplier_im", orbit->cycle.row.multiplier_im[0]);
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

/* The largest line of the spectrum; omega: of the pivot, rad/s, NaN = not known. */
static void print_line(const kz_orbit_features *p, double omega, FILE *summary) {
  const char *unit = p->chaotic ? "rad per drive radian" : "rad";
  const double scale = kz_si_factor(omega, &unit), share = (double)p->dominant / (double)p->record_periods;
  fprintf(summary, "; largest line%s %.6g %s at %" PRId64 "/%" PRId64 " of the drive frequency",
          p->chaotic ? " of the velocity" : "", p->amplitude[p->dominant] * scale, unit, p->dominant,
          p->record_periods);
  if (!isnan(omega)) fprintf(summary, " (%.4g Hz)", share * omega / (2 * M_PI));
}

void kz_orbit_print(const kz_orbit *orbit, FILE *summary) {
  const kz_orbit_features *p = &orbit->features;
  const double omega = orbit->scene->parameters.pivot_frequency;
  const char *unit = "drive periods";
  const double time = (double)p->period * kz_si_factor(omega, &unit);
  if (p->closed)
    fprintf(summary, "orbit: %s, closes after %" PRId64 " period%s", p->name, p->period, p->period > 1 ? "s" : "");
  else
    print_open(orbit, summary);
  if (p->closed && !isnan(omega)) fprintf(summary, " (%.4g %s)", time, unit);
  if (p->dominant > 0) print_line(p, omega, summary);
  if (!p->closed && isfinite(orbit->lyapunov)) {
    fputs("; largest Lyapunov exponent ", summary);
    kz_rate_print(&orbit->scene->parameters, orbit->lyapunov, orbit->lyapunov_error, summary);
  }
  fprintf(summary, "\n");
}

kz_status kz_orbit_write(const kz_orbit *orbit, kz_store *store) {
  KZ_TRY(write_series(orbit, store));
  KZ_TRY(write_features(&orbit->features, store));
  return write_attributes(orbit, store);
}
