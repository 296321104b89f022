/* One drive period at extreme numbers against the quad reference and theory; a lost state becomes NaN. */
#include "../tools/reference.h"
#include "../tools/test.h"

#include <float.h>
#include <math.h>

#include "kapitza/dynamics_steps.h"
#include "kapitza/kernel.h"

enum { RK4 = 0, SPLIT6 = 1, PROCESSED = 2, N = 8 }; /* rows of the schemes */

static const kz_numerics fine = {.scheme = SPLIT6, .steps_per_period = 24};

static void numbers_advance(const kz_pendulum *pendulum, const kz_numerics *numerics, double *theta, double *velocity) {
  int64_t turns[N] = {0};
  kz_flow *flow = kz_flow_create(pendulum, numerics);
  assert_non_null(flow);
  kz_advance(flow, N, 1, theta, velocity, turns);
  kz_flow_free(flow);
}

/* N starts: the seam, one step beside it, the rest positions, and between. */
static void put_starts(double speed, double *theta, double *velocity) {
  const double angles[N] = {M_PI, nextafter(M_PI, 0), -M_PI, 0, 5e-324, 1e-8, 1, -2.5};
  for (int i = 0; i < N; i++) {
    theta[i] = angles[i];
    velocity[i] = i % 2 ? -speed : speed;
  }
}

/* The largest error of one period, rad. */
static double true_error(const kz_pendulum *pendulum, const kz_numerics *numerics, double speed) {
  double theta[N], velocity[N], theta_true[N], velocity_true[N], largest = 0;
  kz_reference_state states[N];
  int64_t turns[N] = {0};
  put_starts(speed, theta, velocity);
  kz_reference_start(N, theta, velocity, NULL, states);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, N, 1, states);
  kz_reference_read(N, states, theta_true, velocity_true, turns);
  numbers_advance(pendulum, numerics, theta, velocity);
  for (int i = 0; i < N; i++)
    largest = fmax(largest, hypot(remainder(theta[i] - theta_true[i], 2 * M_PI), velocity[i] - velocity_true[i]));
  return largest;
}

/* Within 1e-4 rad, from which on the program warns. */
TEST(a_period_is_right_at_the_extremes) {
  const double ms[] = {0, 1e-300, 5e-324, 1e-8, -0.3, 1}, betas[] = {0, 5e-324, 1e-12, 1, 40},
               ks[] = {0, -0.1, 1e-16, 0.25}, speeds[] = {0, 1e-300, 1e-320, 1e-8, 2};
  for (int a = 0; a < 6; a++)
    for (int b = 0; b < 5; b++)
      for (int c = 0; c < 4; c++)
        for (int d = 0; d < 5; d++) {
          const kz_pendulum pendulum = {ks[c], betas[b], ms[a]};
          const double error = true_error(&pendulum, &fine, speeds[d]);
          if (!(error < 1e-4)) fail_msg("k %g beta %g m %g speed %g: %g", ks[c], betas[b], ms[a], speeds[d], error);
        }
}

TEST(what_diverges_is_told) {
  const struct {
    kz_pendulum pendulum;
    kz_numerics numerics;
  } cases[] = {{{0.01, 50, 0.3}, {.scheme = RK4, .steps_per_period = 100}},
               {{0.01, 1e3, 0.3}, {.scheme = RK4, .steps_per_period = 100}},
               {{0.01, 1e4, 0.3}, {.scheme = SPLIT6, .steps_per_period = 24}},
               {{0.01, 1e300, 0.3}, {.scheme = SPLIT6, .steps_per_period = 24}}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    const double speed[] = {0, 2};
    double error;
    kz_step_errors(&cases[i].pendulum, &cases[i].numerics, 1, speed, &error);
    assert_true(error == DBL_MAX);
  }
}

/* Angles without a fraction are not angles: the state is NaN. */
TEST(lost_angles_are_not_numbers) {
  const kz_pendulum pendulum = {0, 0, 0};
  const kz_numerics numerics = {.scheme = SPLIT6, .steps_per_period = 24};
  double theta[N], velocity[N];
  put_starts(1e17, theta, velocity);
  numbers_advance(&pendulum, &numerics, theta, velocity);
  for (int i = 0; i < N; i++) assert_true(isnan(theta[i]));
}
