/* Cycles found from points of other cycles are closed ones, and most of those that a grid shows. */
#include <math.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "kapitza/dynamics.h"

enum { NODES = 129, MOST = 512 };
static const kz_pendulum FIG13 = {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.46};

/* rad: how far a cycle [3] is from coming back after its period. */
static double gap(const double cycle[3]) {
  kz_numerics fine;
  kz_numerics_fine(&FIG13, &fine);
  kz_plan *map = kz_plan_create(&FIG13, &fine);
  double theta = M_PI * cycle[1], velocity = cycle[2];
  const double from = theta;
  int64_t turns = 0;
  kz_advance(map, 1, (int64_t)cycle[0], &theta, &velocity, &turns);
  kz_plan_free(map);
  return hypot(remainder(theta - from, 2 * M_PI), velocity - cycle[2]);
}

static int64_t scan(double cycle[MOST][3]) {
  double theta[NODES], velocity[NODES];
  for (int i = 0; i < NODES; i++) {
    theta[i] = M_PI * (2.0 * i / (NODES - 1) - 1);
    velocity[i] = 2.0 * i / (NODES - 1);
  }
  return kz_dynamics_scan_cycles(&FIG13, 3, NODES, theta, NODES, velocity, MOST, cycle[0]);
}

static void test_three_periods_from_two(void **state) {
  (void)state;
  static double known[MOST][3], found[MOST][3], seed[MOST][2];
  int64_t n_seeds = 0, of_three = 0, met = 0;
  const int64_t n = scan(known);
  assert_true(n > 4 && n <= MOST);
  for (int64_t i = 0; i < n; i++) {
    if (known[i][0] != 2) continue;
    for (int side = -1; side <= 1; side += 2, n_seeds++) {
      seed[n_seeds][0] = side * known[i][1];
      seed[n_seeds][1] = side * known[i][2];
    }
  }
  const int64_t m = kz_dynamics_stabilised_cycles(&FIG13, 3, n_seeds, seed[0], MOST, found[0]);
  assert_true(m > 0 && m <= MOST);
  for (int64_t i = 0; i < m; i++) assert_true((found[i][0] == 1 || found[i][0] == 3) && gap(found[i]) < 1e-5);
  for (int64_t i = 0; i < n; i++) {
    if (known[i][0] != 3) continue;
    of_three++;
    kz_numerics fine;
    kz_numerics_fine(&FIG13, &fine);
    for (int64_t j = 0; j < m; j++) { /* the same point, the next one, or a mirror image of them */
      double theta = M_PI * found[j][1], velocity = found[j][2];
      int64_t turns = 0;
      kz_plan *map = kz_plan_create(&FIG13, &fine);
      bool same = false;
      for (int period = 0; period < 3; period++) {
        for (int side = -1; side <= 1; side += 2)
          same = same || hypot(remainder(side * theta - M_PI * known[i][1], 2 * M_PI), side * velocity - known[i][2]) < 1e-4;
        kz_advance(map, 1, 1, &theta, &velocity, &turns);
      }
      kz_plan_free(map);
      if (!same) continue;
      met++;
      break;
    }
  }
  assert_true(of_three > 0 && 4 * met >= 3 * of_three);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_three_periods_from_two)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
