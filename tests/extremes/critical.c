/* Attractors near a bifurcation: the right one or none, never one that is not there, never two taken for one. */
#include "../tools/test.h"

#include <math.h>
#include <stdlib.h>

#include "../tools/find.h"
#include "kapitza/dynamics_labels.h"
#include "kapitza/dynamics_cycles.h"

enum { SPLIT6 = 1, RK4 = 0, STATES = 64, MOST = 64 };

static const double PI = 3.14159265358979323846;
/* The steps of published values, and of scenes. */
static const kz_numerics fine = {.scheme = SPLIT6, .steps_per_period = 96},
                         usual = {.scheme = SPLIT6, .steps_per_period = 24},
                         rk4 = {.scheme = RK4, .steps_per_period = 100};

static kz_pendulum critical_blackburn(double m) {
  return (kz_pendulum){1.0 / 121, 1.0 / 55, m};
}

/* The lowest point of the second tongue (Q = 5), where `down` gives way to two motions of period 1. */
static kz_pendulum second_tongue(double m) {
  const double k = 1.0856905702485;
  return (kz_pendulum){k, sqrt(k) / 5, m};
}

/* The multiplier of a rest position that is farthest from 0. */
static double critical_multiplier(const kz_pendulum *pendulum, const kz_numerics *numerics, double theta) {
  double velocity = 0;
  kz_attractor cycle;
  kz_dynamics_close_cycle(pendulum, numerics, 1, 0.1, &theta, &velocity, &cycle);
  assert_int_equal(cycle.period, 1);
  return cycle.multiplier_re[0];
}

/* The m between low and high from which on |multiplier| > 1. */
static double critical_critical(kz_pendulum (*family)(double), const kz_numerics *numerics, double theta, double low,
                                double high) {
  for (;;) {
    const double m = (low + high) / 2;
    if (m <= low || m >= high) return low;
    const kz_pendulum pendulum = family(m);
    if (fabs(critical_multiplier(&pendulum, numerics, theta)) < 1)
      low = m;
    else
      high = m;
  }
}

/* Where flutter begins, to the last digits of the reference; how far the steps of a scene move it. */
TEST(the_flip_is_where_it_should_be) {
  const double known = 0.46819030239029;
  assert_true(fabs(critical_critical(critical_blackburn, &fine, PI, 0.468, 0.4684) - known) < 1e-14);
  assert_true(fabs(critical_critical(critical_blackburn, &usual, PI, 0.468, 0.4684) - known) < 2e-12);
  assert_true(fabs(critical_critical(critical_blackburn, &rk4, PI, 0.468, 0.4684) - known) < 4e-8);
}

/* A search near n states from (theta, velocity), each offset a little less than the one before. */
static kz_dynamics *critical_searched(const kz_pendulum *pendulum, const kz_numerics *numerics, const double centre[2],
                                      const double largest[2], double smallest) {
  double state[2 * STATES];
  int32_t label[STATES];
  int64_t periods[STATES];
  kz_dynamics *d = kz_dynamics_create(pendulum, numerics, 12);
  assert_non_null(d);
  kz_dynamics_regions(d, 0, 3);
  for (int i = 0; i < STATES; i++) {
    const double share = pow(smallest, (double)i / STATES);
    state[2 * i] = (centre[0] + share * largest[0]) / PI;
    state[2 * i + 1] = centre[1] + share * largest[1];
  }
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, STATES, 100, state, label, periods, NULL);
  find_cycles(d, STATES, state, 0.02);
  return d;
}

/* Either side of epsilon_c: below, inverted attracts without flutter; above, flutter grows as a square root. */
TEST(a_flip_is_never_mistaken) {
  const double begin = critical_critical(critical_blackburn, &fine, PI, 0.468, 0.4684), centre[2] = {PI, 0},
               offset[2] = {-0.01, 0.001};
  for (int i = 0; i < 240; i += getenv("KAPITZA_EXTENSIVE") ? 1 : 8) {
    const double distance = (i % 3 ? -1 : 1) * pow(10, -12 + 6.0 * i / 240);
    const kz_pendulum pendulum = critical_blackburn(begin + distance);
    kz_dynamics *d = critical_searched(&pendulum, &usual, centre, offset, 1e-4);
    int inverted = 0;
    for (int64_t a = 1; a <= kz_dynamics_count(d); a++) {
      kz_attractor row;
      double theta[MOST], velocity[MOST];
      kz_dynamics_attractor(d, a, &row);
      kz_dynamics_strobe(d, a, theta, velocity);
      if (row.period == 1) inverted++;
      if (row.period == 1 && distance > 0) fail_msg("inverted attracts at epsilon_c + %g", distance);
      if (row.period > 1 && distance < 0)
        fail_msg("a cycle of amplitude %g at epsilon_c - %g", row.amplitude, -distance);
      if (row.period > 1 && !(fabs(row.amplitude / (3.7926 * sqrt(distance)) - 1) < 0.01))
        fail_msg("flutter of amplitude %g at epsilon_c + %g", row.amplitude, distance);
    }
    assert_int_equal(inverted, distance < 0);
    kz_dynamics_free(d);
  }
}

/* Beyond the pitchfork of `down` two mirror images attract, so far apart. */
TEST(mirror_images_are_two) {
  const kz_numerics steps = {.scheme = SPLIT6, .steps_per_period = 192};
  const double begin = critical_critical(second_tongue, &steps, 0, 0.995, 0.996), centre[2] = {0, 0};
  for (double apart = 1e-3; apart > 5e-7; apart /= 10) { /* rounding may leave open where the nearest pair is */
    const kz_pendulum pendulum = second_tongue(begin + pow(apart / 5.04, 2));
    const double offset[2] = {0.6 * apart, 0.45 * apart};
    kz_dynamics *d = critical_searched(&pendulum, &steps, centre, offset, 0.5);
    const int64_t count = kz_dynamics_count(d);
    if (!(count == 2 || (count == 0 && apart < 5e-6))) fail_msg("%d attractors, not two %g apart", (int)count, apart);
    kz_attractor row[2];
    double theta[2][MOST], velocity[2][MOST];
    for (int a = 0; a < count; a++) {
      kz_dynamics_attractor(d, a + 1, &row[a]);
      kz_dynamics_strobe(d, a + 1, theta[a], velocity[a]);
      assert_int_equal(row[a].period, 1);
      assert_int_equal(row[a].mirror, 2 - a);
    }
    if (count == 2) {
      assert_true(theta[0][0] == -theta[1][0] && velocity[0][0] == -velocity[1][0]);
      assert_true(fabs(hypot(theta[0][0] - theta[1][0], velocity[0][0] - velocity[1][0]) / apart - 1) < 0.01);
    }
    kz_dynamics_free(d);
  }
}

/* Dynamics on a made-up map with two attracting fixed points so far apart, at velocities +-apart/2 (doublet.f90). */
kz_dynamics *kz_test_doublet_create(double apart);

/* Two attractors, whatever their distance down to 1e-7, and no start is ever given to the wrong one. */
TEST(attractors_close_together_are_told_apart) {
  for (double apart = 1e-2; apart > 1e-9; apart /= 2) {
    kz_dynamics *d = kz_test_doublet_create(apart);
    double state[2 * STATES];
    int32_t label[STATES];
    int64_t periods[STATES];
    for (int i = 0; i < STATES; i++) {
      state[2 * i] = 0;
      state[2 * i + 1] = (i - STATES / 2) * apart / 20;
    }
    kz_dynamics_regions(d, 0, 3);
    find_cycles(d, STATES, state, 0.02);
    kz_dynamics_update(d);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, STATES, 2000, state, label, periods, NULL);
    const int64_t count = kz_dynamics_count(d);
    assert_int_equal(count, apart > 1e-7 ? 2 : 1);
    for (int i = 0; i < STATES && count == 2; i++) {
      kz_attractor row;
      double theta[MOST], velocity[MOST];
      if (apart > 4e-7) assert_int_equal(label[i] > 0, i != STATES / 2); /* nearer ones may stay unsettled */
      if (label[i] == 0) continue;
      kz_dynamics_attractor(d, label[i], &row);
      kz_dynamics_strobe(d, label[i], theta, velocity);
      if (!(velocity[0] * (i - STATES / 2) > 0)) fail_msg("apart %g: start %d goes to %g", apart, i, velocity[0]);
    }
    kz_dynamics_free(d);
  }
}
