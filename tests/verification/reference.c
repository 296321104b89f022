/* The quad-precision reference against published cycles, exact solutions, itself with other steps, split6. */
#include <math.h>
#include <string.h>

#include "../tools/reference.h"
#include "../tools/test.h"

#include "kapitza/kernel.h"

#define PI 3.14159265358979323846
#define Q5_11(m_) {1.0 / 121, 1.0 / 55, m_}

typedef struct {
  double theta, velocity;
  int64_t turns;
} motion;

static motion reference_carried(kz_pendulum pendulum, int32_t steps, int64_t periods, double theta, double velocity) {
  kz_reference_state state;
  motion end;
  kz_reference_start(1, &theta, &velocity, NULL, &state);
  kz_reference_advance(&pendulum, steps, 1, periods, &state);
  kz_reference_read(1, &state, &end.theta, &end.velocity, &end.turns);
  return end;
}

static double reference_between(double a, double b) {
  return fabs(remainder(a - b, 2 * PI));
}

/* Attracting cycles of tests/literature/reference.json (16 digits) close after their period, with their winding. */
TEST(published_cycles_close) {
  static const struct {
    kz_pendulum pendulum;
    int64_t period, winding;
    double theta, velocity;
  } cycles[] = {
      {Q5_11(0.3), 1, 1, 3.0164225972238089, 1.0688105148992054},
      {Q5_11(0.3), 6, 2, 5.4788494374559386, 0.3726893811078418},
      {Q5_11(0.3), 6, -2, 5.5589419598303097, -0.3597945192840554},
      {{0.02, 0.011785113019775792, 0.412}, 3, 0, 0.06180411278639920, 0.29743888564254975},
  };
  for (size_t i = 0; i < sizeof cycles / sizeof *cycles; i++) {
    motion end = reference_carried(cycles[i].pendulum, KZ_REFERENCE_STEPS, cycles[i].period, cycles[i].theta,
                                   cycles[i].velocity);
    assert_true(reference_between(end.theta, cycles[i].theta) < 4e-15);
    assert_true(fabs(end.velocity - cycles[i].velocity) < 4e-15);
    double net = 2 * PI * (double)end.turns + end.theta - cycles[i].theta;
    assert_int_equal(lround(net / (2 * PI)), cycles[i].winding);
  }
}

/* k = m = 0: theta = theta0 + v (1 - e^(-beta t)) / beta, v e^(-beta t). */
TEST(free_rotor_is_exact) {
  const double beta = 0.05, theta = 0.3, velocity = 1.7;
  motion end = reference_carried((kz_pendulum){0, beta, 0}, KZ_REFERENCE_STEPS, 3, theta, velocity);
  assert_true(reference_between(end.theta, theta - velocity * expm1(-6 * PI * beta) / beta) < 1e-14);
  assert_true(fabs(end.velocity - velocity * exp(-6 * PI * beta)) < 1e-15);
  assert_int_equal(end.turns, 3); /* 21.05 rad */
}

/* A long chaotic transient multiplies any error: doubles still agree to the last bits for any number of steps. */
TEST(steps_do_not_matter) {
  static const struct {
    double m, theta, velocity;
    int64_t periods;
  } starts[] = {{0.46, 1.1, -0.37, 40}, {0.3, -2.9, 1.9, 40}, {0.52, 0.4, 0.2, 40}, {3.0, 0.1, 0, 3}, {0.3, 1, 50, 1}};
  for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
    kz_pendulum pendulum = Q5_11(starts[i].m);
    motion a = reference_carried(pendulum, 11, starts[i].periods, starts[i].theta, starts[i].velocity);
    motion b = reference_carried(pendulum, 27, starts[i].periods, starts[i].theta, starts[i].velocity);
    assert_true(reference_between(a.theta, b.theta) < 1e-15);
    assert_true(fabs(a.velocity - b.velocity) <= 1e-15 * (1 + fabs(b.velocity)));
    assert_int_equal(a.turns, b.turns);
  }
}

TEST(mirror_is_exact) {
  motion end = reference_carried((kz_pendulum)Q5_11(0.46), KZ_REFERENCE_STEPS, 20, 2.7, -1.3);
  motion mirrored = reference_carried((kz_pendulum)Q5_11(0.46), KZ_REFERENCE_STEPS, 20, -2.7, 1.3);
  assert_true(end.theta == -mirrored.theta && end.velocity == -mirrored.velocity && end.turns == -mirrored.turns);
}

/* A start at rest whose first force vanishes (k = m), rest itself, and motions too fast or too slow for their size. */
TEST(odd_starts) {
  const kz_pendulum level = {0.3, 0.05, 0.3};
  motion a = reference_carried(level, 9, 2, 1, 0), b = reference_carried(level, 31, 2, 1, 0);
  assert_true(fabs(a.theta - b.theta) < 1e-15 && fabs(a.theta - 1) > 1e-3);
  motion rest = reference_carried(level, KZ_REFERENCE_STEPS, 5, 0, 0);
  assert_true(rest.theta == 0 && rest.velocity == 0 && rest.turns == 0);
  motion tiny = reference_carried(level, KZ_REFERENCE_STEPS, 1, 0, 1e-300),
         small = reference_carried(level, KZ_REFERENCE_STEPS, 1, 0, 1e-100);
  assert_true(fabs(tiny.velocity * 1e200 / small.velocity - 1) < 1e-14);
  assert_true(isnan(reference_carried(level, KZ_REFERENCE_STEPS, 1, 0, 1e300).theta));
}

/* Many states in one call, and their quads kept between calls, move as one state at a time does. */
TEST(batches_and_calls_do_not_matter) {
  enum { N = 5 };
  const kz_pendulum pendulum = Q5_11(0.46);
  double theta[N], velocity[N], theta0[N], velocity0[N];
  int64_t turns[N];
  kz_reference_state states[N];
  for (int i = 0; i < N; i++) {
    theta0[i] = theta[i] = i - 2.1;
    velocity0[i] = velocity[i] = 0.3 * i - 0.7;
  }
  kz_reference_start(N, theta, velocity, NULL, states);
  for (int call = 0; call < 10; call++) kz_reference_advance(&pendulum, KZ_REFERENCE_STEPS, N, 3, states);
  kz_reference_read(N, states, theta, velocity, turns);
  for (int i = 0; i < N; i++) {
    motion alone = reference_carried(pendulum, KZ_REFERENCE_STEPS, 30, theta0[i], velocity0[i]);
    assert_true(alone.theta == theta[i] && alone.velocity == velocity[i] && alone.turns == turns[i]);
  }
}
