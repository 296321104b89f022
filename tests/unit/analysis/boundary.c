/* Boundaries of known dimension, basins that share theirs, lifetimes of known means. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/test.h"

#include "kapitza/analysis.h"
#include "kapitza/analysis_boundary.h"

enum { SIDE = 2187 }; /* 3^7 */
static int16_t label[256 + 1][SIDE];

/* The step of Cantor's construction that removes x, counted from 0: its gaps have the Cantor set as their only
 * limit. */
static int gap_of(double x) {
  for (int step = 0; step < 34; step++) {
    x *= 3;
    const int third = (int)x;
    if (third == 1) return step;
    x -= third;
  }
  return 34;
}

static void boundary_fill(int16_t (*of)(int row, int column)) {
  for (int row = 0; row <= 256; row++)
    for (int column = 0; column < SIDE; column++) label[row][column] = of(row, column);
}

static int16_t boundary_line(int row, int column) {
  return column - 3 * row > 700;
}

static int16_t boundary_stripes(int row, int column) {
  (void)row;
  return (int16_t)(column / 100 % 3);
}

static int16_t cantor_3(int row, int column) {
  (void)row;
  return (int16_t)(gap_of((column + 0.5) / SIDE) % 3);
}

/* A line has the dimension 1, stripes over a Cantor set 1 + ln 2/ln 3: over the scales of three triadic steps. */
TEST(test_dimensions) {
  kz_box_counts counts = {0};
  boundary_fill(boundary_line);
  kz_boxes_count(SIDE, 257, label[0], KZ_BOX_SIZES, &counts);
  for (int level = 0; level < 5; level++) assert_true(fabs(kz_boxes_dimension(&counts, level) - 1) < 0.05);
  memset(&counts, 0, sizeof counts);
  boundary_fill(cantor_3);
  kz_boxes_count(SIDE, 257, label[0], KZ_BOX_SIZES, &counts);
  double mean = 0;
  for (int level = 2; level < 7; level++) mean += kz_boxes_dimension(&counts, level) / 5;
  assert_true(fabs(mean - (1 + log(2) / log(3))) < 0.06);
}

/* Gaps taken in turn by three labels share the whole Cantor set (Wada); each boundary of stripes belongs to two of
 * three. */
TEST(test_which_basins_share_their_boundary) {
  kz_box_counts wada = {0}, pairs = {0};
  boundary_fill(cantor_3);
  kz_boxes_count(SIDE, 257, label[0], KZ_BOX_SIZES, &wada);
  boundary_fill(boundary_stripes);
  kz_boxes_count(SIDE, 257, label[0], KZ_BOX_SIZES, &pairs);
  for (int i = 0; i < 3; i++) {
    assert_true((double)wada.with[6][i] > 0.99 * (double)wada.boxes[6]);
    assert_true(fabs((double)pairs.with[4][i] / (double)pairs.boxes[4] - 2.0 / 3) < 0.05);
  }
  assert_true(wada.with[6][3] == 0);
}

/* Every cell is in a box of each size, whatever the sizes of the grid and however it is cut into strips. */
TEST(test_boxes_hold_every_cell) {
  static const int sides[][2] = {{16, 16}, {80, 80}, {64, 49}, {131, 300}, {257, 130}};
  static int16_t grid[300 * 300];
  for (int64_t i = 0; i < 300 * 300; i++) grid[i] = (int16_t)((i * 2654435761u >> 13) % 97 == 0 ? i % 3 - 1 : 0);
  for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
    const int columns = sides[s][0], rows = sides[s][1], sizes = kz_box_sizes(columns, rows);
    kz_box_counts whole = {0}, strips = {0}, expected = {0};
    kz_boxes_count(columns, rows, grid, sizes, &whole);
    for (int row = 0; row + 1 < rows; row += 128)
      kz_boxes_count(columns, rows - row < 129 ? rows - row : 129, grid + row * columns, sizes, &strips);
    for (int size = 0; size < sizes; size++)
      for (int top = 0; top + 1 < rows; top += 1 << size)
        for (int left = 0; left + 1 < columns; left += 1 << size) {
          bool held[2] = {false, false};
          for (int r = top; r <= top + (1 << size) && r < rows; r++)
            for (int c = left; c <= left + (1 << size) && c < columns; c++)
              if (grid[r * columns + c] >= 0) held[grid[r * columns + c]] = true;
          if (!held[0] || !held[1]) continue;
          expected.boxes[size]++;
          expected.with[size][0]++;
          expected.with[size][1]++;
        }
    assert_true(sizes == (columns == 16 ? 5 : rows < 64 ? 6 : columns < 128 ? 7 : 8));
    assert_true(memcmp(&whole, &expected, sizeof whole) == 0 && memcmp(&strips, &expected, sizeof strips) == 0);
  }
}

/* The line goes through all distances, not through the ends; few uncertain pairs have no say; scatter widens the
 * interval. */
TEST(test_line_through_all_distances) {
  const kz_uncertain bent[] = {{8, 1000, 800}, {4, 1000, 700}, {2, 1000, 400}, {1, 1000, 200}, {0.5, 1000, 29}};
  const double y[] = {log(0.8), log(0.7), log(0.4), log(0.2)};
  const double slope = (1.5 * (y[0] - y[3]) + 0.5 * (y[1] - y[2])) / 5 / M_LN2;
  const kz_slope line = kz_uncertainty_line(5, bent), two = kz_uncertainty_line(2, bent + 2),
                 one = kz_uncertainty_line(2, bent + 3);
  assert_true(fabs(line.slope - slope) < 1e-12 && line.far == 8 && line.near == 1);
  assert_true(line.low < 0.6 && 0.75 < line.high && fabs(line.low + line.high - 2 * slope) < 1e-12);
  assert_true(fabs(two.slope - 1) < 1e-12 && two.low < 1 && 1 < two.high && isnan(one.slope) && isnan(one.far));
}

/* Pairs of points on a line whose gaps are coloured by turns: exponent 1 - ln 2/ln 3 over every decade; of one point it
 * is 1. */
TEST(test_uncertainty_exponents) {
  enum { DISTANCES = 7, PAIRS = 40000 };
  kz_uncertain cantor[DISTANCES], point[DISTANCES];
  kz_slope slope[DISTANCES - 1];
  for (int d = 0; d < DISTANCES; d++) {
    cantor[d] = point[d] = (kz_uncertain){.distance = pow(10, -2 - d), .pairs = PAIRS};
    for (int i = 0; i < PAIRS; i++) {
      const double x = fmod(i * 0.61803398874989484820, 1), y = x + cantor[d].distance;
      cantor[d].uncertain += y < 1 && gap_of(x) % 2 != gap_of(y) % 2;
      point[d].uncertain += (x < 0.5) != (y < 0.5);
    }
  }
  const double exact = 1 - log(2) / log(3);
  const kz_slope whole = kz_uncertainty_slopes(DISTANCES, cantor, slope);
  assert_true(whole.low < exact && exact < whole.high && whole.high - whole.low < 0.1);
  assert_true(whole.near < 1e-6 && whole.far == 0.01);
  for (int d = 1; d < 4; d++) assert_true(fabs(slope[d].slope - exact) < 0.15);
  const kz_slope smooth = kz_uncertainty_slopes(DISTANCES, point, slope);
  assert_true(smooth.low < 1 && 1 < smooth.high && smooth.near > 1e-4);
  assert_true(isnan(slope[5].slope) || slope[5].high == INFINITY);
}

/* The lifetime of so many motions that last a period each, beside ten times as many that settle at once. */
static kz_lifetime lifetime_of_ones(int64_t count) {
  uint32_t *time = calloc((size_t)(11 * count), sizeof *time);
  for (int64_t i = 0; i < count; i++) time[11 * i] = 1;
  const kz_lifetime life = kz_lifetime_tail(11 * count, time, 2);
  free(time);
  return life;
}

/* Exponential times, some still open: the interval holds the mean; where none has ended, there is a lower end alone. */
TEST(test_lifetimes) {
  enum { N = 4000 };
  static uint32_t time[N];
  uint64_t seed = 1;
  int64_t open = 0;
  const double mean = 320000, longest = 500000;
  for (int i = 0; i < N; i++) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    const double t = -mean * log(((double)(seed >> 11) + 0.5) / 9007199254740992.0);
    time[i] = t < longest ? (uint32_t)t : KZ_NOT_ENDED;
    open += t >= longest;
  }
  const kz_lifetime life = kz_lifetime_tail(N, time, longest);
  assert_true(life.low < mean && mean < life.high && life.high - life.low < 0.12 * mean && life.open == open);
  assert_true(fabs(life.mean - mean) < 0.06 * mean && life.from > 50000 && life.from < 250000);
  const kz_lifetime few = lifetime_of_ones(199), more = lifetime_of_ones(201), many = lifetime_of_ones(100000);
  assert_true(fabs((few.high - 1) / (more.high - 1) - sqrt(201.0 / 199)) < 1e-3 && few.mean == 1 && more.mean == 1);
  assert_true(fabs((few.low - 1) / (more.low - 1) - sqrt(201.0 / 199)) < 1e-3);
  assert_true(fabs(many.high - many.low - 2 * 1.96 / sqrt(100000)) < 1e-4);
  for (int i = 0; i < 1000; i++) time[i] = KZ_NOT_ENDED;
  const kz_lifetime none = kz_lifetime_tail(1000, time, 300);
  assert_true(isnan(none.mean) && none.high == INFINITY && fabs(none.low - 1000 * 300 / -log(0.05)) < 1e-6 * none.low);
}
