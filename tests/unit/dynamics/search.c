/* What the search for cycles costs. */
#include "../../tools/test.h"

#include "kapitza/dynamics.h"

enum { STATES = 64 };

int64_t kz_test_newton_periods(const kz_pendulum *pendulum, int64_t settle, double closeness, int64_t *known);

/* Orbits on a chaotic set come near themselves again and again, always beside a cycle that repels: Newton's method leaves most of
 * those alone. (It took 31, 79 and 126 periods a state here when it tried them all.) */
TEST(test_chaos) {
  static const kz_pendulum pendulums[] = {{0.4278, 0.4419, 2.942}, {-0.0797, 0.0996, 2.8414}, {0.51, 0.0411, 0.8033}};
  for (int i = 0; i < 3; i++) {
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

/* Slow spirals come near themselves all the time, and most of them lead to the same cycles. Fine steps are for those that are new. (It took
 * 114 periods a state here for the same twelve; with another rounding some orbits miss two of these.) */
TEST(test_slow_spirals) {
  int64_t known;
  assert_true(kz_test_newton_periods(&(kz_pendulum){1.0 / 121, 1.0 / 660, 0.3}, 270, 0.32, &known) < 20 * STATES);
  assert_in_range(known, 9, 14);
}
