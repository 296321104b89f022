/* Cell centres of a window given by its middle: pairs of doubles, offsets, mirror images. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "numerics/cells.h"

static kz_axis window(const char *centre, double high, double low, double width, int64_t count) {
  kz_axis axis = {.min = high - width / 2, .max = high + width / 2, .count = count, .width = {"w", width, 0}};
  snprintf(axis.centre.text, sizeof axis.centre.text, "%s", centre);
  axis.centre.high = high;
  axis.centre.low = low;
  return axis;
}

/* 17 + 1e-18 and cells of 1e-20/8: every digit of the sums is there. */
static void cells_below_the_last_place_of_a_double(void **state) {
  (void)state;
  const kz_axis axis = window("17.000000000000000001", 17, 1e-18, 1e-20, 8);
  assert_true(kz_axis_is_deep(&axis));
  assert_true(kz_axis_step(&axis) == 1e-20 / 8);
  for (int64_t i = 0; i < 8; i++) {
    double pair[2];
    kz_axis_pair(&axis, i, pair);
    assert_true(pair[0] == 17 && kz_axis_centre(&axis, i) == 17);
    assert_true(fabs(pair[1] - (1e-18 + (2 * (double)i - 7) * (1e-20 / 16))) < 1e-32);
    assert_true(fabs(kz_axis_offset(&axis, i) - (2 * (double)i - 7) * (1e-20 / 16)) < 1e-35);
  }
}

/* A quarter of the way along, and 1e-25 more; the same between edges that are doubles. */
static void points_below_the_last_place_of_a_double(void **state) {
  (void)state;
  const kz_axis deep = window("17.000000000000000001", 17, 1e-18, 1e-20, 8), edges = {.min = 1, .max = 3, .count = 8};
  double pair[2];
  kz_axis_at(&deep, 0.25, 1e-25, pair);
  assert_true(pair[0] == 17 && fabs(pair[1] - (1e-18 - 0.25e-20 + 1e-25)) < 1e-32);
  kz_axis_at(&edges, 0.25, 1e-25, pair);
  assert_true(pair[0] == 1.5 && fabs(pair[1] - 1e-25) < 1e-33);
}

/* Attractors are looked for in a neighbourhood of such a window, and in just the window where doubles tell its cells apart. */
static void a_neighbourhood_is_searched(void **state) {
  (void)state;
  const kz_axis deep = window("1.42", 1.42, 0, 1e-20, 8), wide = window("0.5", 0.5, 0, 0.25, 8);
  const kz_window searched = kz_window_of(&wide, &deep);
  assert_true(searched.theta_min == 0.375 && searched.theta_max == 0.625);
  assert_true(fabs(searched.velocity_max - searched.velocity_min - 1e-6) < 1e-12);
}

static void a_window_about_the_origin_is_its_own_mirror_image(void **state) {
  (void)state;
  kz_basin_plan plan = {.theta = window("0", 0, 0, 1e-20, 7), .velocity = window("0", 0, 0, 3, 4)};
  assert_int_equal(kz_own_cells(&plan), 14);
  for (int64_t f = 0; f < 28; f++) {
    double start[2], low[2], mirror[2], mirror_low[2];
    kz_cell_pairs(&plan, f, start, low);
    kz_cell_pairs(&plan, 27 - f, mirror, mirror_low);
    for (int x = 0; x < 2; x++) assert_true(start[x] == -mirror[x] && low[x] == -mirror_low[x]);
  }
  plan.theta = window("1e-30", 1e-30, 0, 1, 7); /* its edges are those of a mirrored window to all digits of a double */
  assert_int_equal(kz_own_cells(&plan), 28);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cells_below_the_last_place_of_a_double),
      cmocka_unit_test(points_below_the_last_place_of_a_double),
      cmocka_unit_test(a_neighbourhood_is_searched),
      cmocka_unit_test(a_window_about_the_origin_is_its_own_mirror_image),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
