/* Cells of a frame by raster: each own cell is followed once, for the first raster that shows it or its image. */
#include <stdlib.h>

#include "../../tools/test.h"

#include "live/live.h"

/* Whether all cells that a raster shows, or their mirror images, have been listed. */
static bool is_shown(int64_t coarseness, int64_t rows, int64_t columns, int64_t own, const int *times) {
  for (int64_t i = 0; i < kz_raster_size(coarseness, rows); i++)
    for (int64_t j = 0; j < kz_raster_size(coarseness, columns); j++) {
      const int64_t f = kz_raster_place(coarseness, i, rows) * columns + kz_raster_place(coarseness, j, columns);
      if (times[f < own ? f : rows * columns - 1 - f] == 0) return false;
    }
  return true;
}

static void rasters_check(int64_t rows, int64_t columns, int64_t own) {
  bool *listed = calloc((size_t)own, sizeof *listed);
  int *times = calloc((size_t)own, sizeof *times);
  int64_t *number = calloc((size_t)(rows * columns), sizeof *number);
  for (int64_t coarseness = 8; coarseness >= 1; coarseness /= 2) {
    const int64_t n = kz_raster_pending(coarseness, rows, columns, own, listed, number);
    for (int64_t i = 0; i < n; i++) {
      assert_in_range(number[i], 0, own - 1);
      times[number[i]]++;
    }
    assert_true(is_shown(coarseness, rows, columns, own, times));
  }
  for (int64_t i = 0; i < own; i++) assert_int_equal(times[i], 1);
  free(listed);
  free(times);
  free(number);
}

TEST(each_own_cell_is_followed_once) {
  static const int64_t counts[] = {1, 2, 7, 16, 25};
  enum { N = sizeof counts / sizeof *counts };
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      rasters_check(counts[i], counts[j], counts[i] * counts[j]);
      rasters_check(counts[i], counts[j], (counts[i] * counts[j] + 1) / 2);
    }
}
