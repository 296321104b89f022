/* Proved trapping regions against orbits: no start in them ends elsewhere, and what cannot be proved is not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "kapitza/dynamics.h"

/* Fig. 12's pendulum and its rotation of one turn a period (tests/literature). */
static const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
static const double THETA = 3.0164225972238, VELOCITY = 1.0688105148992;
enum { ROTATION = 1, OPPOSITE = 2, COLUMNS = 120, ROWS = 120, PERIODS = 250 };
static const double TOP = 2;

static void ellipses_that_hold_and_that_do_not(void **state) {
  (void)state;
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, &proof), KZ_OK);
  kz_proof_ellipse ellipse = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  assert_true(ellipse.radius > 0.3 && ellipse.radius < 1);
  ellipse.radius = 5e-3;
  assert_true(kz_proof_traps(proof, 1, THETA, VELOCITY, &ellipse));
  assert_false(kz_proof_traps(proof, 1, THETA, VELOCITY + 0.01, &ellipse)); /* the cycle lies outside */
  assert_false(
      kz_proof_traps(proof, 2, THETA, VELOCITY + 0.002, &(kz_proof_ellipse){5e-3, {{1, 0}, {0, 1}}})); /* another norm */
  ellipse.radius = 0.3;
  assert_false(kz_proof_traps(proof, 1, THETA, VELOCITY, &ellipse));
  assert_true(kz_proof_find_ellipse(proof, 1, 1.0, 0.5).radius <= 0); /* no cycle */
  kz_proof_free(proof);
  const kz_pendulum slow = {1.0 / 121, 1.0 / 55, 0.1}; /* inverted: a saddle */
  assert_int_equal(kz_proof_create(&slow, COLUMNS, ROWS, TOP, &proof), KZ_OK);
  assert_true(kz_proof_find_ellipse(proof, 1, -M_PI, 0).radius <= 0);
  assert_true(kz_proof_find_ellipse(proof, 1, 0, 0).radius > 0.1);
  kz_proof_free(proof);
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, 1e9, &proof), KZ_REFUSED);
  kz_proof_free(proof);
}

/* Where nine starts of a cell, its corners among them, end: a rotation, 0 = elsewhere; -1 = at different places. */
static int end_of_cell(const kz_plan *plan, const kz_proof *proof, int64_t f, int *proved) {
  double theta[9], velocity[9];
  int64_t turns[9] = {0};
  for (int i = 0; i < 9; i++) {
    theta[i] = ((double)(f % COLUMNS) + 0.49999 * (i % 3) + 1e-5) * 2 * M_PI / COLUMNS - M_PI;
    velocity[i] = ((double)(f / COLUMNS) + 0.49999 * (i / 3) + 1e-5) * 2 * TOP / ROWS - TOP;
  }
  *proved = kz_proof_at(proof, theta[4], velocity[4]);
  assert_int_equal(kz_proof_at(proof, -theta[4], -velocity[4]), *proved == 0 ? 0 : 3 - *proved);
  kz_advance(plan, 9, PERIODS, theta, velocity, turns);
  int end = 0;
  for (int i = 0; i < 9; i++) {
    const int to = fabs(velocity[i] - VELOCITY) < 1e-3 ? ROTATION : fabs(velocity[i] + VELOCITY) < 1e-3 ? OPPOSITE : 0;
    end = i == 0 || to == end ? to : -1;
  }
  return end;
}

static void grown_cells_end_where_they_are_said_to(void **state) {
  (void)state;
  const uint8_t mirror[KZ_PROOF_MOST + 1] = {0, OPPOSITE, ROTATION};
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS / 2, ROWS / 2, TOP, &proof), KZ_OK);
  const kz_proof_ellipse ellipse = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  kz_proof_draw(proof, ROTATION, OPPOSITE, THETA, VELOCITY, &ellipse);
  uint8_t *label = malloc(COLUMNS * ROWS);
  int64_t added[4];
  for (int round = 0; round < 4; round++) {
    if (round == 2) assert_int_equal(kz_proof_refine(proof), KZ_OK);
    kz_proof_cells(proof, 0, kz_proof_own(proof) / 2, label);
    kz_proof_cells(proof, kz_proof_own(proof) / 2, kz_proof_own(proof) / 2, label + kz_proof_own(proof) / 2);
    added[round] = kz_proof_adopt(proof, label, mirror);
  }
  assert_true(added[0] > 0 && added[2] > 0);
  kz_numerics numerics = {.scheme = kz_scheme_find("processed")};
  double error;
  assert_int_equal(kz_numerics_choose(&pendulum, 1e-9, 2.5, &numerics, &error), KZ_OK);
  kz_plan *plan = kz_plan_create(&pendulum, &numerics);
  int n_proved = 0, n_mixed = 0;
  for (int64_t f = 0; f < COLUMNS * ROWS / 2; f++) {
    int proved;
    const int end = end_of_cell(plan, proof, f, &proved);
    assert_true(proved == 0 || proved == end);
    n_proved += proved > 0;
    n_mixed += end == -1;
  }
  assert_true(n_proved > 0.15 * COLUMNS * ROWS / 2 && n_mixed > 100);
  kz_plan_free(plan);
  kz_proof_free(proof);
  free(label);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(ellipses_that_hold_and_that_do_not),
                                     cmocka_unit_test(grown_cells_end_where_they_are_said_to)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
