/* Tiles of a window cover it, mirror each other, and their counts add up to those of the whole. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/test.h"

#include "basin/basin.h"

static kz_scene scene_of(int64_t theta, int64_t velocity, double min, int64_t max_periods) {
  static kz_basin_plan plan;
  plan = (kz_basin_plan){.theta = {-M_PI, M_PI, theta},
                         .velocity = {min, 2, velocity},
                         .max_periods = max_periods,
                         .method = KZ_METHOD_ICM};
  return (kz_scene){.numerics = {.steps_per_period = 24}, .basin = &plan};
}

/* Consecutive cells, each once; the own tiles hold the own cells; mirrored tiles are as long. */
static void tiles_check(int64_t theta, int64_t velocity, double min, int64_t max_periods) {
  const kz_scene scene = scene_of(theta, velocity, min, max_periods);
  const kz_tiles t = kz_tiles_of(&scene, 4096);
  int64_t next = 0, own = 0;
  for (int64_t i = 0; i < t.n; i++) {
    assert_int_equal(kz_tile_first(&t, i), next);
    next += kz_tile_count(&t, i);
    assert_in_range(kz_tile_count(&t, i), 1, kz_tile_capacity(&t));
    if (t.own < t.n) assert_int_equal(kz_tile_count(&t, i), kz_tile_count(&t, t.n - 1 - i));
    if (i < t.own) own += kz_tile_own(&t, i);
  }
  assert_int_equal(next, theta * velocity);
  assert_int_equal(own, t.unique_cells);
}

TEST(tiles_cover_the_window) {
  static const int64_t counts[] = {1, 2, 7, 97, 100, 101, 250, 997, 1000, 1024};
  enum { N = sizeof counts / sizeof *counts };
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      tiles_check(counts[i], counts[j], -2, 2000);
      tiles_check(counts[i], counts[j], -1, 2000);
      tiles_check(counts[i], counts[j], -2, 10000000);
      tiles_check(counts[i], counts[j], -1, 10000000);
    }
}

/* 10^10 cells: numbers beyond 32 bits, tiles of few MB that hold whole boxes. */
TEST(large_grids_are_addressed) {
  const kz_scene scene = scene_of(100000, 100000, -2, 2000);
  const kz_tiles t = kz_tiles_of(&scene, 4096);
  assert_true(t.whole && t.own == t.n / 2 && kz_tile_capacity(&t) <= 1 << 19);
  assert_true(kz_tile_first(&t, t.n - 1) + kz_tile_count(&t, t.n - 1) == INT64_C(10000000000));
  tiles_check(100000, 100000, -2, 2000);
}

enum { ROWS = 20, COLUMNS = 64 };

static double entropy_of(const kz_counts *counts) {
  double entropy, boundary;
  kz_entropy_of(counts, &entropy, &boundary);
  return boundary;
}

TEST(counts_of_parts_add_up) {
  static int16_t label[ROWS * COLUMNS];
  kz_counts whole = {0}, parts = {0};
  srand(1);
  for (int i = 0; i < ROWS * COLUMNS; i++) label[i] = (int16_t)(rand() % 5 - 1);
  kz_count_boxes(COLUMNS, ROWS, label, &whole);
  kz_count_pairs(COLUMNS, ROWS, label, true, &whole);
  for (int row = 0; row < ROWS; row += KZ_BOX) {
    kz_count_boxes(COLUMNS, KZ_BOX, label + row * COLUMNS, &parts);
    kz_count_pairs(COLUMNS, KZ_BOX, label + row * COLUMNS, true, &parts);
  }
  assert_memory_equal(&whole, &parts, sizeof whole);
  assert_true(entropy_of(&whole) > 1 && kz_uncertain_share(&whole, 0) > 0.5);
}

TEST(measures_of_a_pattern) {
  enum { WIDE = 20 };
  int16_t halves[10 * WIDE], some[10 * WIDE];
  kz_counts pattern = {0}, circle = {0}, unsettled = {0};
  double entropy, boundary;
  for (int i = 0; i < 10 * WIDE; i++) {
    halves[i] = (int16_t)(i % WIDE < 10 ? 0 : i / WIDE % 2 + 1);
    some[i] = (int16_t)(i % WIDE < 10 ? 0 : i / WIDE % 2 == 0 ? 1 : -1);
  }
  kz_count_boxes(WIDE, 10, halves, &pattern);
  kz_entropy_of(&pattern, &entropy, &boundary);
  const double first = -0.6 * log(0.6) - 0.4 * log(0.4); /* three rows of five against two */
  assert_true(fabs(boundary - first) < 1e-15 && fabs(entropy - first / 2) < 1e-15);
  kz_count_pairs(WIDE, 10, halves, false, &pattern);
  assert_true(kz_uncertain_share(&pattern, 0) == 2.0 / 18);
  kz_count_pairs(WIDE, 10, halves, true, &circle);
  assert_true(kz_uncertain_share(&circle, 0) == 4.0 / 20);
  kz_count_boxes(WIDE, 10, some, &unsettled);
  kz_entropy_of(&unsettled, &entropy, &boundary);
  assert_true(entropy == 0 && boundary == 0);
  kz_count_pairs(WIDE, 10, some, false, &unsettled);
  assert_int_equal(unsettled.compared[0], 5 * 18 + 5 * 8); /* a row of halves, a row whose second half is left out */
  assert_int_equal(unsettled.uncertain[0], 5 * 2);
}
