/* Cost of the search for cycles. */
#include "../../tools/part.h"
#include "../../tools/test.h"

#include "kapitza/dynamics.h"

enum { STATES = 64 };

int64_t kz_test_newton_periods(const kz_pendulum *pendulum, int64_t settle, double closeness, int64_t *known);
double kz_test_rims(const kz_pendulum *pendulum, int64_t settle, double closeness, double *radius);

/* Orbits on a chaotic set come near themselves again and again, always beside a cycle that repels: Newton's method
 * leaves most of those alone. (It took 31, 79 and 126 periods a state here when it tried them all.) */
TEST(test_chaos) {
  static const kz_pendulum pendulums[] = {{0.4278, 0.4419, 2.942}, {-0.0797, 0.0996, 2.8414}, {0.51, 0.0411, 0.8033}};
  for (int i = 0; i < (PART > 1 ? 1 : 3); i++) {
    int64_t known;
    assert_true(kz_test_newton_periods(pendulums + i, 2000, 0.3, &known) < 10 * STATES);
  }
}

/* Cycles that attract are tried: all seven of Fig. 12, and the five of a strong drive. */
TEST(test_cycles) {
  int64_t known;
  kz_test_newton_periods(&(kz_pendulum){1.0 / 121, 1.0 / 55, 0.3}, 200, 0.02, &known);
  assert_int_equal(known, 7);
  kz_test_newton_periods(&(kz_pendulum){0.2283, 0.0468, 1.7225}, 40, 0.02, &known);
  assert_int_equal(known, 5);
}

/* Slow spirals come near themselves all the time, and most of them lead to the same cycles. Fine steps are for those
 * that are new. (It took 114 periods a state here for the same twelve; with another rounding some orbits miss two of
 * these.) */
TEST(test_slow_spirals) {
  int64_t known;
  assert_true(kz_test_newton_periods(&(kz_pendulum){1.0 / 121, 1.0 / 660, 0.3}, 270, 0.32, &known) < 20 * STATES);
  assert_in_range(known, 9, 14);
}

/* Motions that spiral in slowly are trapped far from their cycle: in ellipses whose rims come to it in the end.
 * (Ellipses that one return carries inside themselves are some .001 rad wide here.) */
TEST(test_wide_ellipses) {
  double radius;
  assert_true(kz_test_rims(&(kz_pendulum){1.0 / 121, 1.0 / 660, 0.3}, 270, 0.32, &radius) < 0.001);
  assert_true(radius > 0.05);
  if (PART > 1) return;
  assert_true(kz_test_rims(&(kz_pendulum){1.0 / 121, 1.0 / 2200, 0.3}, 400, 0.02, &radius) < 0.001);
  assert_true(radius > 0.05);
}

/* Orbits of a lifetime have come nowhere near a cycle yet: the means of their states are near it. (Two were found.) */
TEST(test_centres) {
  int64_t known;
  if (PART > 1) return; /* test_slow_spirals shows the sanitizers the same code */
  kz_test_newton_periods(&(kz_pendulum){1.0 / 121, 1.0 / 6600, 0.3}, 2000, 0.02, &known);
  assert_true(known >= 8);
}
