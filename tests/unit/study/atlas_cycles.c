/* Points of curves in their canonical form: what is a shorter cycle, or rest, is told to be so. */
#include "../../tools/test.h"

#include <math.h>
#include <string.h>

#include "atlas/curves.h"
#include "atlas/cycles.h"
#include "atlas/records.h"
#include "saddles/saddles.h"

/* k = x, beta = 0.1, m = y. */
static bool pendulum_at(const void *context, const double place[2], kz_pendulum *pendulum) {
  (void)context;
  *pendulum = (kz_pendulum){place[0], 0.1, place[1]};
  return true;
}
static const kz_plane PLANE = {.pendulum = pendulum_at, .low = {-1, -1}, .high = {3, 3}, .steps = 96, .mirrored = 1};
static const double UP[2] = {0, 1};

/* Beside the place where upright rest leans over Newton's method for a fold ends on rest itself, with few digits. */
TEST(test_a_fold_beside_rest_is_the_curve_of_rest) {
  const kz_atlas atlas = {.plane = PLANE};
  kz_cycle_kind kind = {{1, 1, 1, 0, 0}, -1};
  double y[4] = {M_PI - 4e-5, 3.6e-7, 0.0047902, 0.09}, elsewhere[4];
  const kz_curve_kind leans = {-1, 1, -1, 1, 0};
  double rest[4] = {M_PI, 0, y[2], y[3]};
  assert_int_equal(kz_curve_locate(&PLANE, &leans, rest, UP), 1);
  y[3] = rest[3];
  memcpy(elsewhere, y, sizeof elsewhere);
  elsewhere[3] += 0.01;
  assert_false(kz_atlas_reduce(&atlas, 1e-4, &kind, elsewhere));
  assert_true(kz_atlas_reduce(&atlas, 1e-4, &kind, y));
  assert_true(kind.rest == 1 && kind.of.side == -1 && kind.of.multiplier == -1 && kind.of.turns == 1 && y[0] == M_PI);
  assert_false(kz_atlas_reduce(&atlas, 1e-4, &kind, y));
}

/* A third of a symmetric cycle of six periods has two: here where swings of the inverted rest lose symmetry. */
TEST(test_a_third_of_a_symmetric_cycle) {
  const kz_atlas atlas = {.plane = PLANE};
  const kz_curve_kind swings = {1, 1, -1, 0, 0}, symmetric = {-1, 1, -1, 1, 0};
  double y[8] = {M_PI, 0, -0.05, 0.5}, vector[2], form, side[2];
  assert_int_equal(kz_curve_locate(&PLANE, &swings, y, UP), 1);
  assert_int_equal(kz_curve_form(&PLANE, &swings, y, &form, side, vector), 1);
  for (int i = 0; i < 2; i++) y[i] += 0.6 * vector[i];
  y[3] += 0.09;
  assert_int_equal(kz_curve_locate(&PLANE, &symmetric, y, UP), 1);
  assert_true(fabs(y[0] - M_PI) > 0.1);
  y[6] = y[2], y[7] = y[3];
  for (int i = 2; i < 6; i++) y[i] = (i % 2 ? 0 : 2 * M_PI) - y[i - 2];
  kz_cycle_kind kind = {{-1, 3, -1, 1, 0}, -1};
  assert_true(kz_atlas_reduce(&atlas, 1e-5, &kind, y));
  assert_true(kind.of.points == 1 && kind.of.side == -1 && kind.of.multiplier == -1 && kind.of.turns == 1);
}

/* A file's row has a cycle's first point alone, angle in [-pi, pi]; the completed others close as its kind does. */
TEST(test_a_row_of_a_file_is_completed) {
  const kz_atlas atlas = {.plane = PLANE};
  const kz_curve_kind swings = {1, 1, -1, 0, 0}, symmetric = {-1, 1, -1, 1, 0};
  double y[4] = {M_PI, 0, -0.05, 0.5}, vector[2], form, side[2], row[KZ_ROW_POINTS + 2] = {0};
  assert_int_equal(kz_curve_locate(&PLANE, &swings, y, UP), 1);
  assert_int_equal(kz_curve_form(&PLANE, &swings, y, &form, side, vector), 1);
  for (int i = 0; i < 2; i++) y[i] += 0.6 * vector[i];
  y[3] += 0.09;
  assert_int_equal(kz_curve_locate(&PLANE, &symmetric, y, UP), 1);
  if (y[0] < M_PI) y[0] = 2 * M_PI - y[0], y[1] = -y[1]; /* its image */
  kz_atlas_curve curve = {.kind = {symmetric, -1}, .n = 1, .row = row};
  row[0] = y[2], row[1] = y[3];
  row[KZ_ROW_POINTS] = remainder(y[0], 2 * M_PI), row[KZ_ROW_POINTS + 1] = y[1];
  assert_true(row[KZ_ROW_POINTS] < 0);
  kz_atlas_complete(&atlas, &curve, 0);
  assert_true(fabs(row[KZ_ROW_POINTS] - y[0]) < 1e-12 && row[KZ_ROW_POINTS + 1] == y[1]);
}

/* A cycle of three periods at its fold or its doubling in a band 3e-8 wide, told twice round, beside the place where it
 * is by the error of one. At the fold no such cycle may exist there; at the doubling its trace differs by 1e-3. */
TEST(test_twice_round_in_a_narrow_band) {
  static const struct {
    kz_curve_kind of;
    double at[4], beside;
  } of_three[] = {
      {{1, 3, 1, 1, 0}, {-0.130013356382532, 0.102831005803898, -0.534401758096531, 1.299673584314393}, 1e-13},
      {{1, 3, -1, 3, 0}, {-2.960795023656967, 2.511593812951067, -0.204525016945798, 1.341701909182105}, 4e-12}};
  const kz_atlas atlas = {.plane = PLANE};
  for (int i = 0; i < 4; i++) {
    const kz_curve_kind *of = &of_three[i / 2].of;
    kz_cycle_kind kind = {{1, 6, 1, 2 * of->turns, 0}, -1};
    double once[8], y[14];
    memcpy(once, of_three[i / 2].at, 2 * sizeof *once);
    assert_int_equal(kz_curve_orbit(&PLANE, of_three[i / 2].at + 2, 2, 3, once), 1);
    memcpy(once + 6, of_three[i / 2].at + 2, 2 * sizeof *once);
    assert_int_equal(kz_curve_locate(&PLANE, of, once, UP), 1);
    for (int c = 0; c < 12; c++) y[c] = once[c % 6] + (c >= 6 && c % 2 == 0 ? 2 * M_PI * of->turns : 0);
    y[12] = once[6], y[13] = once[7] + (i % 2 ? -1 : 1) * of_three[i / 2].beside;
    assert_true(kz_atlas_reduce(&atlas, 1e-5, &kind, y));
    assert_true(!memcmp(&kind.of, of, sizeof *of) && kind.rest == -1);
  }
}

/* A record that is full says how many seeds it has no room for. */
TEST(test_a_full_record_counts_what_it_drops) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds seeds = {0};
  KZ_AUTOFREE char *record = kz_malloc(KZ_ATLAS_SEEDS_BYTES);
  const kz_plane_cycle seed = {.kind = {{1, 1, 0, 0, 0}, -1}};
  const int64_t most = KZ_ATLAS_SEEDS_BYTES / (int64_t)sizeof seed;
  for (int64_t i = 0; i < most + 5; i++) {
    kz_atlas_put(&seeds, &seed);
    kz_atlas_put_seeds(&seeds, record);
    const kz_atlas_seeds kept = kz_atlas_seeds_in(record);
    assert_int_equal(kept.count + kept.dropped, i + 1);
    assert_true(kept.dropped == 0 || kept.count >= most - 1);
  }
  assert_true(kz_atlas_seeds_in(record).dropped >= 5);
  kz_atlas_seeds none = {.dropped = 2}; /* for which the search had no room */
  kz_atlas_put_seeds(&none, record);
  assert_int_equal(kz_atlas_seeds_in(record).dropped, 2);
}

/* A line of starts that is searched as a whole shows the cycles of its pieces. */
TEST(test_a_line_has_the_cycles_of_its_pieces) {
  enum { PERIODS = 2, STRIDE = 2 + 2 * PERIODS };
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.5};
  const kz_saddles_plan plan = {
      .theta = {.min = -M_PI, .max = M_PI}, .velocity = {.min = -2, .max = 2}, .max_period = PERIODS};
  kz_lines pieces = kz_lines_of(&pendulum, &plan, 0), whole = pieces;
  KZ_AUTOFREE double *found = kz_malloc(2 * kz_piece_bytes(&plan));
  int64_t work[2], all[2] = {0}, n = 0;
  pieces.steepest = whole.steepest = 1e4;
  whole.cells *= whole.pieces, whole.pieces = 1;
  for (int64_t piece = 0; piece < pieces.pieces; piece++) {
    n += kz_lines_search(&pieces, 3 * pieces.pieces + piece, INT64_MAX, found + n * STRIDE, work);
    for (int i = 0; i < 2; i++) all[i] += work[i];
  }
  assert_true(n > 3 && kz_lines_search(&whole, 3, INT64_MAX, found + n * STRIDE, work) == n);
  assert_memory_equal(found, found + n * STRIDE, (size_t)(n * STRIDE) * sizeof *found);
  assert_memory_equal(work, all, sizeof all);
}

enum { TAYLORS = 3, MOST_CYCLES = 300 };
/* Adds cycles of Taylor's rotor that lines of so many cells show to (period, largest speed) cycle [MOST_CYCLES]. */
static int add_cycles(double steepest, int64_t cells, double cycle[][2], int n) {
  const kz_pendulum pendulum = {.k = 2.25, .beta = 0.375, .torque_amplitude = 2.2, .unmirrored = 1};
  const kz_saddles_plan plan = {
      .theta = {.min = -M_PI, .max = M_PI}, .velocity = {.min = -4, .max = 4}, .max_period = TAYLORS};
  KZ_AUTOFREE double *found = kz_malloc(kz_piece_bytes(&plan));
  kz_lines lines = kz_lines_of(&pendulum, &plan, 0);
  lines.steepest = steepest;
  lines.cells = cells;
  for (int64_t piece = 0; piece < lines.count * lines.pieces; piece++) {
    int64_t work[2];
    const double *c = found;
    for (int64_t left = kz_lines_search(&lines, piece, INT64_MAX, found, work); left > 0;
         left--, c += 2 + 2 * TAYLORS) {
      int i = 0;
      while (i < n && (cycle[i][0] != c[0] || fabs(cycle[i][1] - c[1]) > 1e-5)) i++;
      assert_true(i < MOST_CYCLES);
      if (i == n) cycle[n][0] = c[0], cycle[n++][1] = c[1];
    }
  }
  return n;
}

/* By the image half a period later a limit of 30 is one of some 900 over a period: nine of these cycles are below 30
 * over a period, twelve half a period later. */
TEST(test_symmetric_cycles_close_half_a_period_later) {
  double cycle[MOST_CYCLES][2];
  const int limited = add_cycles(30, 8, cycle, 0);
  assert_int_equal(limited, 12);
  assert_int_equal(add_cycles(30, 64, cycle, limited), limited);
  double every[MOST_CYCLES][2];
  const int all = add_cycles(1000, 64, every, 0);
  for (int i = 0; i < limited; i++) {
    int j = 0;
    while (j < all && (every[j][0] != cycle[i][0] || fabs(every[j][1] - cycle[i][1]) > 1e-5)) j++;
    assert_true(j < all);
  }
}
