/* One cycle carried from parameters to parameters, against physics known to many digits (Q = 5, Omega = 11). */
#include "../../tools/test.h"

#include <math.h>

#include "../../tools/part.h"
#include "kapitza/dynamics.h"

static const double PI = 3.14159265358979323846;

static kz_pendulum pendulum(double m) {
  return (kz_pendulum){1.0 / 121, 1.0 / 55, m};
}

/* Where flutter begins. */
static const double CRITICAL = 0.46819030239029;

/* Flutter at m = 0.47, carried to `m` in small steps of the logarithm of the distance from its birth. */
static kz_branch_point flutter(double m) {
  kz_branch_point point = {.theta = PI + 0.16, .velocity = -0.0022, .period = 2, .symmetric = 1};
  const int steps = 40;
  for (int i = 0; i <= steps; i++) {
    const kz_pendulum p = pendulum(CRITICAL + (0.47 - CRITICAL) * pow((m - CRITICAL) / (0.47 - CRITICAL), (double)i / steps));
    assert_int_equal(kz_branch_continue(&p, &point, 0.1, &point), 1);
  }
  return point;
}

/* The published strobe points, amplitudes and multipliers of the half map. */
TEST(test_flutter) {
  static const double known[][6] = {
      /* m, phi, phi', amplitude, half map */
      {0.47, 0.161076997267223124, -0.002241504186408954, 0.16111093243808042, 0.9147951308392979, 0.23493391956730758},
      {0.5, 0.6602414615359, -0.0088710808640, 0, 0.3676, 0.8700}};
  for (int i = 0; i < 2; i++) {
    const kz_branch_point point = flutter(known[i][0]);
    const double turned = fabs(remainder(point.theta - PI, 2 * PI)) - known[i][1];
    assert_true(fabs(turned) < 1e-11 && fabs(fabs(point.velocity) + known[i][2]) < 1e-11);
    if (known[i][3] > 0) assert_true(fabs(point.amplitude - known[i][3]) < 1e-9);
    const double tolerance = i == 0 ? 1e-8 : 5.1e-5;
    assert_true(fabs(point.half_re[0] - known[i][4]) < tolerance && fabs(point.half_im[0] - known[i][5]) < tolerance);
    assert_int_equal(point.centre, 1);
    assert_true(fabs(hypot(point.half_re[0], point.half_im[0]) - exp(-PI / 55)) < 1e-12);
  }
}

/* At the end of the mirror symmetry the half map passes -1. */
TEST(test_symmetry_breaking) {
  const kz_branch_point before = flutter(0.5618456), after = flutter(0.5618457);
  assert_true(before.half_re[0] > -1 && after.half_re[0] < -1);
  assert_true(fabs(before.multiplier_re[0] - 1) < 1e-4 && hypot(before.multiplier_re[0], before.multiplier_im[0]) < 1);
}

/* Rotations keep their winding, mirror images mirror, and the whole orbit is the same cycle from any of its points. */
TEST(test_rotation) {
  const kz_pendulum p = pendulum(0.3);
  kz_branch_point point = {.theta = 3.0164, .velocity = 1.0688, .period = 1, .winding = 1}, image, other;
  assert_int_equal(kz_branch_continue(&p, &point, 0.01, &point), 1);
  assert_true(fabs(point.theta - 3.0164225972238) < 1e-12 && fabs(point.velocity - 1.06881051489920) < 1e-12);
  assert_true(fabs(point.multiplier_re[0] + 0.7133) < 1e-4 && fabs(point.multiplier_im[0] - 0.6191) < 1e-4);
  image = point;
  image.theta = -point.theta;
  image.velocity = -point.velocity;
  image.winding = -1;
  assert_int_equal(kz_branch_continue(&p, &image, 1e-6, &other), 1);
  assert_true(fabs(other.theta + point.theta) < 1e-13 && fabs(other.velocity + point.velocity) < 1e-13);
  assert_int_equal(kz_branch_same(&p, &point, &other), 0);
  assert_int_equal(kz_branch_same(&p, &point, &point), 1);
}

/* What is not there is not found: flutter below its birth, a cycle out of reach, a rotation below its fold. */
TEST(test_refusals) {
  kz_branch_point point = flutter(0.4683), out;
  const kz_pendulum below = pendulum(0.468), far = pendulum(0.52), still = pendulum(0.02);
  assert_int_equal(kz_branch_continue(&below, &point, 0.5, &out), 0);
  point = flutter(0.47);
  assert_int_equal(kz_branch_continue(&far, &point, 0.1, &out), 0);
  const kz_branch_point rotation = {.theta = 1.57, .velocity = 1, .period = 1, .winding = 1};
  assert_int_equal(kz_branch_continue(&still, &rotation, 3, &out), 0);
}

/* Where three periods take a start, in the coordinates of the map. */
static void carry(kz_dynamics *dynamics, double end[2]) {
  int32_t label;
  int64_t periods;
  end[0] = 0.3;
  end[1] = 0.4;
  kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, 1, 3, end, &label, &periods);
}

/* Along a slider the coefficients are interpolated: the map is that of a pendulum made anew, forwards, back, and after a leap. */
TEST(test_slider) {
  enum { STEPS = PART > 1 ? 8 : 40 };
  const kz_numerics numerics = {.scheme = kz_scheme_find("processed"), .steps_per_period = 40};
  for (int by_k = 0; by_k < (PART > 1 ? 1 : 2); by_k++) {
    kz_pendulum p = pendulum(0.3);
    kz_dynamics *moved = kz_dynamics_create(&p, &numerics, 4);
    kz_dynamics_coarse_regions(moved, 3);
    for (int i = 1; i <= STEPS; i++) {
      int64_t lost;
      double end[2], known[2];
      *(by_k ? &p.k : &p.m) += i == STEPS / 2 ? 0.05 : i < 3 * STEPS / 4 ? 3e-4 : -1e-3;
      kz_dynamics *next = kz_dynamics_continue(moved, &p, &numerics, &lost), *anew = kz_dynamics_create(&p, &numerics, 4);
      kz_dynamics_coarse_regions(anew, 3);
      carry(next, end);
      carry(anew, known);
      assert_true(fabs(end[0] - known[0]) < 1e-10 && fabs(end[1] - known[1]) < 1e-10);
      kz_dynamics_free(moved);
      kz_dynamics_free(anew);
      moved = next;
    }
    kz_dynamics_free(moved);
  }
}
