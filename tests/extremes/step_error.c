/* The stated error of a drive period is an upper estimate: held against the largest one of a dense sample, pendulum by
 * pendulum. */
#include "../tools/test.h"

#include <math.h>
#include <stdlib.h>

#include "kapitza/dynamics_steps.h"

enum { ANGLES = 128, SPEEDS = 64, N = ANGLES * SPEEDS, CLASSES = 4, PENDULUMS = 5, MORE = 150, FINE = 192 };

static const double PI = 3.14159265358979323846;
/* rad: where rounding takes over, the finer steps are no reference any more. */
static const double ROUNDING = 2e-12;

/* Speeds of one class on a grid, ends included, every class with angles of its own. */
static void put_grid(const double *speed, int class, double *theta, double *velocity) {
  for (int i = 0; i < N; i++) {
    theta[i] = PI * ((2.0 * (i % ANGLES) + 0.13 * class) / ANGLES - 1);
    velocity[i] = speed[0] + (speed[1] - speed[0]) * (i / ANGLES) / (SPEEDS - 1);
  }
}

static void step_error_advance(const kz_pendulum *pendulum, kz_numerics numerics, double *theta, double *velocity) {
  static int64_t turns[N];
  kz_flow *flow = kz_flow_create(pendulum, &numerics);
  assert_non_null(flow);
  kz_advance(flow, N, 1, theta, velocity, turns);
  kz_flow_free(flow);
}

/* The largest error of one period on the grid of one class, rad: split6 with many more steps is the reference. */
static double dense_error(const kz_pendulum *pendulum, const kz_numerics *numerics, const double *speed, int class) {
  static double theta[N], velocity[N], theta_true[N], velocity_true[N];
  const kz_numerics fine = {.scheme = kz_scheme_find("split6"), .steps_per_period = FINE};
  double largest = 0;
  put_grid(speed, class, theta, velocity);
  put_grid(speed, class, theta_true, velocity_true);
  step_error_advance(pendulum, *numerics, theta, velocity);
  step_error_advance(pendulum, fine, theta_true, velocity_true);
  for (int i = 0; i < N; i++)
    largest = fmax(largest, hypot(remainder(theta[i] - theta_true[i], 2 * PI), velocity[i] - velocity_true[i]));
  return largest;
}

/* A number in [0, 1), the same in every run. */
static double step_error_drawn(void) {
  static uint64_t state = 12;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11) / 9007199254740992.0;
}

TEST(the_stated_error_is_an_upper_estimate) {
  static const struct {
    int32_t scheme, steps;
  } ways[] = {{0, 100}, {0, 60}, {1, 24}, {1, 12}, {2, 24}}; /* rk4, split6, processed */
  const int n = getenv("KAPITZA_EXTENSIVE") ? MORE : PENDULUMS;
  for (int p = 0; p < n; p++) {
    const kz_pendulum pendulum = {0.2 * step_error_drawn() - 0.02, pow(10, -3 + 2.5 * step_error_drawn()),
                                  0.05 + 1.5 * step_error_drawn() * step_error_drawn()};
    const kz_numerics numerics = {.scheme = ways[p % 5].scheme, .steps_per_period = ways[p % 5].steps};
    const double top = pow(10, 1.3 * step_error_drawn());
    double speed[CLASSES + 1] = {0}, stated[CLASSES];
    for (int c = 1; c <= CLASSES; c++) speed[c] = ldexp(top, c - CLASSES);
    kz_step_errors(&pendulum, &numerics, CLASSES, speed, stated);
    for (int c = 0; c < CLASSES; c++) {
      const double error = dense_error(&pendulum, &numerics, speed + c, c);
      if (error > ROUNDING && !(stated[c] >= error && stated[c] <= 3 * error))
        fail_msg("k %g beta %g m %g, scheme %d, speeds %g to %g: %g stated, %g true", pendulum.k, pendulum.beta,
                 pendulum.m, (int)numerics.scheme, speed[c], speed[c + 1], stated[c], error);
    }
  }
}
