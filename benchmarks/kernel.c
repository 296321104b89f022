/* Times one drive period of one trajectory, by this program's kernel and by GSL's rk8pd, and the arithmetic of this
 * core.
 *
 * kernel k beta m STATES PERIODS
 * stdout: "peak F" (fused multiply-adds a nanosecond), a line "state theta velocity theta1 velocity1" for each of 64
 * starts and their images after a period (quad precision), then lines "row NAME TOLERANCE NS ERROR OPERATIONS":
 * nanoseconds a period, the largest error of one period over those starts (rad, angle and velocity together),
 * arithmetic instructions a period (0: not known). Starts: the whole circle, speeds up to 2. The shortest of three
 * times counts. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../tests/tools/reference.h"
#include "kapitza/kernel.h"

enum { PROBES = 64, REPEATS = 3, SLOW_STATES = 16 };
static const double two_pi = 6.28318530717958647692, fastest = 2;
/* Operations of a step besides drift and kick: angle reduced (3), squared, times 1 - square, velocity changed. */
static const int other_operations = 6;

typedef struct {
  double theta[PROBES], velocity[PROBES], theta1[PROBES], velocity1[PROBES];
} probes;

/* Processor time: other processes do not count. */
static double kernel_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#ifdef __AVX512F__
typedef double lanes __attribute__((vector_size(64)));
#else
typedef double lanes __attribute__((vector_size(32)));
#endif

/* Fused multiply-adds a nanosecond, counted in doubles: more chains than a core has units times their latency. */
static double kernel_peak(void) {
  enum { CHAINS = 10, LANES = sizeof(lanes) / sizeof(double), ROUNDS = 1 << 20 };
  double best = 0;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    lanes sum[CHAINS];
    for (int c = 0; c < CHAINS; c++) sum[c] = (lanes){0} + c;
    const lanes a = (lanes){0} + 0.999, b = (lanes){0} + 0.001;
    const double start = kernel_now();
    for (int i = 0; i < ROUNDS; i++) {
#pragma GCC unroll 10
      for (int c = 0; c < CHAINS; c++) sum[c] = sum[c] * a + b;
    }
    const double taken = kernel_now() - start;
    double all = 0;
    for (int c = 0; c < CHAINS; c++)
      for (int l = 0; l < LANES; l++) all += sum[c][l];
    if (isfinite(all)) best = fmax(best, 1e-9 * CHAINS * LANES * ROUNDS / taken);
  }
  return best;
}

/* Starts spread evenly by the additive recurrence of the plastic number. */
static void kernel_spread(int n, double *theta, double *velocity) {
  for (int i = 0; i < n; i++) {
    theta[i] = two_pi * (fmod(0.5 + 0.7548776662466927 * i, 1) - 0.5);
    velocity[i] = 2 * fastest * (fmod(0.5 + 0.5698402909980532 * i, 1) - 0.5);
  }
}

static void make_probes(const kz_pendulum *pendulum, probes *p) {
  static kz_reference_state states[PROBES];
  int64_t turns[PROBES];
  kernel_spread(PROBES, p->theta, p->velocity);
  kz_reference_start(PROBES, p->theta, p->velocity, NULL, states);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, PROBES, 1, states);
  kz_reference_read(PROBES, states, p->theta1, p->velocity1, turns);
}

static double largest_error(const probes *p, const double *theta, const double *velocity) {
  double largest = 0;
  for (int i = 0; i < PROBES; i++)
    largest = fmax(largest, hypot(remainder(theta[i] - p->theta1[i], two_pi), velocity[i] - p->velocity1[i]));
  return largest;
}

/* One row of the table for a flow. */
static bool time_flow(const char *name, double tolerance, const kz_pendulum *pendulum, const kz_numerics *numerics,
                      int operations, const probes *p, int n, int periods) {
  double probe_theta[PROBES], probe_velocity[PROBES], best = INFINITY;
  double *theta = malloc((size_t)n * sizeof *theta), *velocity = malloc((size_t)n * sizeof *velocity);
  int64_t *turns = calloc((size_t)(n > PROBES ? n : PROBES), sizeof *turns);
  kz_flow *flow = kz_flow_create(pendulum, numerics);
  const bool good = theta && velocity && turns && flow;
  if (good) {
    memcpy(probe_theta, p->theta, sizeof probe_theta);
    memcpy(probe_velocity, p->velocity, sizeof probe_velocity);
    kz_advance(flow, PROBES, 1, probe_theta, probe_velocity, turns);
  }
  for (int repeat = 0; good && repeat < REPEATS; repeat++) {
    kernel_spread(n, theta, velocity);
    const double start = kernel_now();
    kz_advance(flow, n, periods, theta, velocity, turns);
    best = fmin(best, kernel_now() - start);
  }
  if (good)
    printf("row %s %g %.3f %.3g %d\n", name, tolerance, 1e9 * best / n / periods,
           largest_error(p, probe_theta, probe_velocity), operations);
  if (flow) kz_flow_free(flow);
  free(theta);
  free(velocity);
  free(turns);
  return good;
}

static bool time_processed(double tolerance, const kz_pendulum *pendulum, const probes *p, int n, int periods) {
  kz_numerics numerics = {.scheme = kz_scheme_find("processed")};
  double error;
  double reached = fastest; /* by the starts after a period, as a scene measures it, with a margin */
  for (int i = 0; i < PROBES; i++) reached = fmax(reached, 1.05 * fabs(p->velocity1[i]));
  if (kz_numerics_choose(pendulum, tolerance, reached, &numerics, &error) != KZ_OK) {
    printf("refused processed %g\n", tolerance);
    return true;
  }
  const int operations = numerics.steps_per_period * (numerics.drift_terms + numerics.kick_terms + other_operations);
  return time_flow("processed", tolerance, pendulum, &numerics, operations, p, n, periods);
}

static int kernel_motion(double t, const double y[], double rate[], void *parameters) {
  const kz_pendulum *p = parameters;
  rate[0] = y[1];
  rate[1] = -p->beta * y[1] - (p->k - p->m * cos(t)) * sin(y[0]);
  return GSL_SUCCESS;
}

/* Whole periods of n states by GSL's rk8pd. */
static bool follow_gsl(const gsl_odeiv2_system *system, double tolerance, int n, int periods, double *theta,
                       double *velocity) {
  gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(system, gsl_odeiv2_step_rk8pd, 0.1, tolerance, tolerance);
  bool good = driver;
  for (int i = 0; good && i < n; i++) {
    double y[2] = {theta[i], velocity[i]}, t = 0;
    good = gsl_odeiv2_driver_reset(driver) == GSL_SUCCESS &&
           gsl_odeiv2_driver_apply(driver, &t, two_pi * periods, y) == GSL_SUCCESS;
    theta[i] = y[0];
    velocity[i] = y[1];
  }
  if (driver) gsl_odeiv2_driver_free(driver);
  return good;
}

static bool time_gsl(double tolerance, const kz_pendulum *pendulum, const probes *p, int periods) {
  gsl_odeiv2_system system = {kernel_motion, NULL, 2, (void *)pendulum};
  double theta[PROBES], velocity[PROBES], some_theta[SLOW_STATES], some_velocity[SLOW_STATES], best = INFINITY;
  memcpy(theta, p->theta, sizeof theta);
  memcpy(velocity, p->velocity, sizeof velocity);
  bool good = follow_gsl(&system, tolerance, PROBES, 1, theta, velocity);
  for (int repeat = 0; good && repeat < REPEATS; repeat++) {
    kernel_spread(SLOW_STATES, some_theta, some_velocity);
    const double start = kernel_now();
    good = follow_gsl(&system, tolerance, SLOW_STATES, periods, some_theta, some_velocity);
    best = fmin(best, kernel_now() - start);
  }
  if (good)
    printf("row GSL-rk8pd %g %.3f %.3g 0\n", tolerance, 1e9 * best / SLOW_STATES / periods,
           largest_error(p, theta, velocity));
  return good;
}

int main(int argc, char **argv) {
  static const double tolerances[] = {1e-4, 1e-7, 1e-10, 3e-10, 1e-12};
  if (argc != 6 || atoi(argv[4]) < 1 || atoi(argv[5]) < 1) {
    fputs("usage: kernel k beta m STATES PERIODS\n", stderr);
    return 2;
  }
  const kz_pendulum pendulum = {atof(argv[1]), atof(argv[2]), atof(argv[3])};
  const int n = atoi(argv[4]), periods = atoi(argv[5]);
  const kz_numerics split6 = {.scheme = kz_scheme_find("split6"), .steps_per_period = 24};
  static probes p;
  gsl_set_error_handler_off();
  make_probes(&pendulum, &p);
  printf("peak %.3f\n", kernel_peak());
  for (int i = 0; i < PROBES; i++)
    printf("state %.17g %.17g %.17g %.17g\n", p.theta[i], p.velocity[i], p.theta1[i], p.velocity1[i]);
  bool good = time_flow("split6-24", 0, &pendulum, &split6, 0, &p, n, periods);
  for (size_t i = 0; good && i < sizeof tolerances / sizeof *tolerances; i++)
    good = time_processed(tolerances[i], &pendulum, &p, n, periods) && time_gsl(tolerances[i], &pendulum, &p, periods);
  if (!good) fputs("kernel: error: out of memory, or GSL does not come to the end of a period\n", stderr);
  return good && fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
