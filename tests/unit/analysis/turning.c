/* Turning points of motions that are known in closed form. */
#include "../../tools/test.h"

#include <math.h>

#include "kapitza/analysis.h"

enum { MOST = 2000 };
static const double PI = 3.14159265358979323846;
static double theta[MOST], velocity[MOST];
static kz_turning_point found[MOST];

/* a cos(t + phase) over `periods`, `samples` a period, both ends. */
static int64_t turning_cosine(int64_t periods, int64_t samples, double a, double phase) {
  int64_t n = periods * samples + 1;
  for (int64_t i = 0; i < n; i++) {
    double t = 2 * PI * (double)i / (double)samples;
    theta[i] = a * cos(t + phase);
    velocity[i] = -a * sin(t + phase);
  }
  return kz_turning_points(n, 2 * PI / (double)samples, theta, velocity, found);
}

TEST(extremes_of_a_cosine) {
  assert_int_equal(turning_cosine(10, 96, 0.7, -0.3), 20);
  for (int i = 0; i < 20; i++) {
    assert_true(fabs(found[i].time - (0.3 + PI * i)) < 1e-10);
    assert_true(fabs(found[i].angle - (i % 2 ? -0.7 : 0.7)) < 1e-13);
  }
}

TEST(coarse_samples_keep_eight_digits) {
  assert_int_equal(turning_cosine(4, 24, 1.0, -0.1), 8);
  for (int i = 0; i < 8; i++) assert_true(fabs(fabs(found[i].angle) - 1) < 1e-9);
}

TEST(release_from_rest_is_not_a_turning_point) {
  for (int i = 0; i < 97; i++) {
    double t = 2 * PI * i / 96;
    theta[i] = 0.5 * cos(t / 3);
    velocity[i] = i == 0 ? 0 : -0.5 / 3 * sin(t / 3);
  }
  assert_int_equal(kz_turning_points(97, 2 * PI / 96, theta, velocity, found), 0);
}

TEST(a_sample_may_lie_on_the_turn) {
  for (int i = 0; i < 9; i++) {
    theta[i] = -(i - 4.0) * (i - 4.0);
    velocity[i] = -2 * (i - 4.0);
  }
  assert_int_equal(kz_turning_points(9, 1, theta, velocity, found), 1);
  assert_true(found[0].time == 4 && found[0].angle == 0);
}

TEST(rest_never_turns) {
  assert_int_equal(turning_cosine(3, 32, 0, 0), 0);
  assert_int_equal(kz_turning_points(3, 0.1, theta, velocity, found), 0);
}
