/* Enclosures of a drive period hold the motion in quad precision, tightly, for random cells of random pendulums. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "kapitza/kernel.h"

enum { SETS = 8, PERIODS = 3 };

static double uniform(double from, double to) {
  return from + (to - from) * rand() / RAND_MAX;
}

static kz_enclosure set_at(double theta, double velocity, double half_theta, double half_velocity) {
  return (kz_enclosure){.theta = theta, .velocity = velocity, .matrix = {{half_theta, 0}, {0, half_velocity}}, .reach = {1, 1}};
}

/* z of the start centre0 + matrix0 y after some periods in quad precision, in the coordinates of the set. */
static void true_place(const kz_pendulum *pendulum, const kz_enclosure *start, const double y[2], int64_t periods,
                       const kz_enclosure *set, double z[2]) {
  double theta = start->theta + start->matrix[0][0] * y[0], velocity = start->velocity + start->matrix[1][1] * y[1];
  kz_reference_state state;
  int64_t turns;
  kz_reference_start(1, &theta, &velocity, NULL, &state);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, 1, periods, &state);
  kz_reference_read(1, &state, &theta, &velocity, &turns);
  const double x = remainder(theta - set->theta, 2 * M_PI), v = velocity - set->velocity;
  const double (*A)[2] = set->matrix, det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
  z[0] = (A[1][1] * x - A[0][1] * v) / det;
  z[1] = (A[0][0] * v - A[1][0] * x) / det;
}

/* Two starts of the set: where they are, and how far they are from each other. */
static bool holds(const kz_pendulum *pendulum, const kz_enclosure *start, int64_t periods, const kz_enclosure *set,
                  double rounding) {
  double y[2][2], z[2][2];
  bool held = true;
  for (int s = 0; s < 2; s++) {
    for (int i = 0; i < 2; i++) y[s][i] = rand() % 2 ? uniform(-1, 1) : rand() % 3 - 1;
    true_place(pendulum, start, y[s], periods, set, z[s]);
    for (int i = 0; i < 2; i++) held &= fabs(z[s][i] - y[s][i]) <= set->reach[i] - 1 + rounding;
  }
  for (int i = 0; i < 2; i++) {
    double bent = 0;
    for (int j = 0; j < 2; j++) bent += set->bend[i][j] * fabs(y[1][j] - y[0][j]);
    held &= fabs(z[1][i] - z[0][i] - (y[1][i] - y[0][i])) <= bent + 2 * rounding;
  }
  return held;
}

/* The cell of Fig. 12's scale, and one so small that only errors of the numerics are left. */
static void sets_hold_the_motion(void **state) {
  (void)state;
  srand(1);
  int kept = 0;
  for (int draw = 0; draw < 40; draw++) {
    const kz_pendulum pendulum = {uniform(-0.05, 0.3), draw % 4 ? uniform(0, 0.1) : 0, uniform(-0.6, 0.6)};
    const double fastest = uniform(0.5, 5), half = draw % 2 ? 2e-3 : 1e-5;
    kz_enclosure_plan *plan;
    assert_int_equal(kz_enclosure_plan_create(&pendulum, fastest + 1, &plan), KZ_OK);
    kz_enclosure start[SETS], set[SETS];
    for (int i = 0; i < SETS; i++) set[i] = start[i] = set_at(uniform(-M_PI, M_PI), uniform(-fastest, fastest), half, half);
    for (int64_t period = 1; period <= PERIODS; period++) {
      kz_enclosures_advance(plan, SETS, set);
      for (int i = 0; i < SETS; i++) {
        if (!isfinite(set[i].reach[0])) continue;
        assert_true(holds(&pendulum, &start[i], period, &set[i], 1e-6));
        kept += set[i].reach[0] + set[i].reach[1] < 3;
      }
    }
    kz_enclosure_plan_free(plan);
  }
  assert_true(kept > 0.65 * 40 * SETS * PERIODS);
}

/* In the smooth part of Fig. 12's plane a cell's image is known to a few per cent of the cell. */
static void images_are_tight(void **state) {
  (void)state;
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_enclosure_plan *plan;
  assert_int_equal(kz_enclosure_plan_create(&pendulum, 3, &plan), KZ_OK);
  for (int i = 0; i < 20; i++) {
    kz_enclosure set = set_at(uniform(-0.3, 0.3), uniform(-0.05, 0.05), 3e-3, 2e-3);
    kz_enclosures_advance(plan, 1, &set);
    assert_true(set.reach[0] < 1.05 && set.reach[1] < 1.05);
  }
  kz_enclosure_plan_free(plan);
}

static void mirror_images_to_the_bit(void **state) {
  (void)state;
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_enclosure_plan *plan;
  assert_int_equal(kz_enclosure_plan_create(&pendulum, 3, &plan), KZ_OK);
  kz_enclosure set[2] = {set_at(2.9, 1.1, 1e-3, 1e-3), set_at(-2.9, -1.1, 1e-3, 1e-3)};
  for (int period = 0; period < PERIODS; period++) kz_enclosures_advance(plan, 2, set);
  assert_true(set[0].theta == -set[1].theta && set[0].velocity == -set[1].velocity);
  for (int i = 0; i < 2; i++) {
    assert_true(set[0].reach[i] == set[1].reach[i]);
    for (int j = 0; j < 2; j++)
      assert_true(set[0].matrix[i][j] == set[1].matrix[i][j] && set[0].bend[i][j] == set[1].bend[i][j]);
  }
  kz_enclosure_plan_free(plan);
}

/* Too fast for the plan, without area, too wide: each is lost, and its neighbours are not. */
static void what_is_not_bounded_is_lost(void **state) {
  (void)state;
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_enclosure_plan *plan;
  assert_int_equal(kz_enclosure_plan_create(&pendulum, 2, &plan), KZ_OK);
  kz_enclosure set[4] = {set_at(0, 2.5, 1e-3, 1e-3), set_at(0, 1, 1e-3, 0), set_at(1, 0, 2, 2), set_at(3, 1, 1e-3, 1e-3)};
  for (int period = 0; period < 2; period++) {
    kz_enclosures_advance(plan, 4, set);
    for (int i = 0; i < 3; i++) assert_true(isinf(set[i].reach[0]) && isinf(set[i].reach[1]));
    assert_true(set[3].reach[0] < 2);
  }
  kz_enclosure_plan_free(plan);
  assert_int_equal(kz_enclosure_plan_create(&pendulum, 1e9, &plan), KZ_REFUSED);
  assert_null(plan);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sets_hold_the_motion), cmocka_unit_test(images_are_tight),
                                     cmocka_unit_test(mirror_images_to_the_bit), cmocka_unit_test(what_is_not_bounded_is_lost)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
