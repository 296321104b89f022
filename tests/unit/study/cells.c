/* Cell centres of a window given by its middle: shares of the width, mirror images. */
#include <math.h>
#include <stdlib.h>

#include "../../tools/test.h"

#include "numerics/cells.h"
#include "kapitza/study_basin.h"

static kz_axis cells_window(const char *centre, double high, double low, double width, int64_t count) {
  kz_axis axis = {.min = high - width / 2, .max = high + width / 2, .count = count, .width = {"", width, 0}};
  snprintf(axis.centre.text, sizeof axis.centre.text, "%s", centre);
  snprintf(axis.width.text, sizeof axis.width.text, "%.17g", width);
  axis.centre.high = high;
  axis.centre.low = low;
  return axis;
}

/* 17 + 1e-18 and cells of 1e-20/8: every digit of the sums is there. */
TEST(cells_below_the_last_place_of_a_double) {
  const kz_axis axis = cells_window("17.000000000000000001", 17, 1e-18, 1e-20, 8);
  assert_true(kz_axis_is_deep(&axis));
  assert_true(kz_axis_step(&axis) == 1e-20 / 8);
  for (int64_t i = 0; i < 8; i++) {
    const kz_coordinate cell = kz_axis_coordinate(&axis, i);
    assert_true(kz_axis_share(&axis, i) == (2 * (double)i - 7) / 16 && cell.share == (2 * (double)i - 7) / 16);
    assert_true(cell.centre == axis.centre.text && cell.width == axis.width.text && kz_axis_centre(&axis, i) == 17);
  }
}

/* A cell of a window between edges is the double of the file, to all digits. */
TEST(cells_between_edges) {
  const kz_axis axis = {.min = 0.1, .max = 0.7, .count = 7};
  for (int64_t i = 0; i < 7; i++) {
    assert_true(kz_axis_coordinate(&axis, i).high == kz_axis_centre(&axis, i));
    assert_true((double)(kz_axis_share(&axis, i) * kz_axis_width(&axis) + (0.1 + 0.7) / 2) == kz_axis_centre(&axis, i));
  }
}

/* A quarter of the way along, and 1e-25 more; the same between edges that are doubles. */
TEST(points_below_the_last_place_of_a_double) {
  const kz_axis deep = cells_window("17.000000000000000001", 17, 1e-18, 1e-20, 8),
                edges = {.min = 1, .max = 3, .count = 8};
  double pair[2];
  kz_axis_at(&deep, 0.25, 1e-25, pair);
  assert_true(pair[0] == 17 && fabs(pair[1] - (1e-18 - 0.25e-20 + 1e-25)) < 1e-32);
  kz_axis_at(&edges, 0.25, 1e-25, pair);
  assert_true(pair[0] == 1.5 && fabs(pair[1] - 1e-25) < 1e-33);
}

/* Attractors are sought near such a window, and in just the window where doubles tell its cells apart. */
TEST(a_neighbourhood_is_searched) {
  const kz_axis deep = cells_window("1.42", 1.42, 0, 1e-20, 8), wide = cells_window("0.5", 0.5, 0, 0.25, 8);
  const kz_window searched = kz_window_of(&wide, &deep);
  assert_true(searched.theta_min == 0.375 && searched.theta_max == 0.625);
  assert_true(fabs(searched.velocity_max - searched.velocity_min - 1e-6) < 1e-12);
}

TEST(a_window_about_the_origin_is_its_own_mirror_image) {
  kz_basin_plan plan = {.theta = cells_window("0", 0, 0, 1e-20, 7), .velocity = cells_window("0", 0, 0, 3, 4)};
  assert_int_equal(kz_unique_cells(&plan), 14);
  for (int64_t f = 0; f < 28; f++) {
    double start[2], mirror[2];
    kz_cell_start(&plan, f, start);
    kz_cell_start(&plan, 27 - f, mirror);
    for (int x = 0; x < 2; x++) assert_true(start[x] == -mirror[x]);
    assert_true(kz_axis_share(&plan.theta, f % 7) == -kz_axis_share(&plan.theta, 6 - f % 7));
  }
  plan.theta =
      cells_window("1e-30", 1e-30, 0, 1, 7); /* its edges are those of a mirrored window to all digits of a double */
  assert_int_equal(kz_unique_cells(&plan), 28);
}
