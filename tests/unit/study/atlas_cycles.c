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
  kz_cycle fold = {.kind = {1, 1, 1}, .place = {0.0047902, 0.09}, .point = {{M_PI - 4e-5, 3.6e-7}}};
  kz_cycle rest = {.kind = {-1, 1, -1, 1}, .place = {0.0047902, 0.09}, .point = {{M_PI}}};
  assert_int_equal(kz_cycle_locate(&PLANE, &rest, UP), 1);
  fold.place[1] = rest.place[1];
  kz_cycle elsewhere = fold;
  elsewhere.place[1] += 0.01;
  assert_false(kz_atlas_reduce(&atlas, 1e-4, &elsewhere));
  assert_true(kz_atlas_reduce(&atlas, 1e-4, &fold));
  assert_true(fold.kind.rest == 2 && fold.kind.side == -1 && fold.kind.multiplier == -1 && fold.kind.turns == 1 &&
              fold.point[0][0] == M_PI);
  assert_false(kz_atlas_reduce(&atlas, 1e-4, &fold));
}

/* A symmetric cycle where it loses its symmetry: beside the place where the swings of upright rest begin. */
static kz_cycle symmetric_cycle(void) {
  kz_cycle cycle = {.kind = {1, 1, -1}, .place = {-0.05, 0.5}, .point = {{M_PI}}};
  kz_normal_form form;
  assert_int_equal(kz_cycle_locate(&PLANE, &cycle, UP), 1);
  assert_int_equal(kz_cycle_form(&PLANE, &cycle, &form), 1);
  for (int i = 0; i < 2; i++) cycle.point[0][i] += 0.6 * form.vector[i];
  cycle.place[1] += 0.09;
  cycle.kind = (kz_cycle_kind){-1, 1, -1, 1};
  assert_int_equal(kz_cycle_locate(&PLANE, &cycle, UP), 1);
  assert_true(fabs(cycle.point[0][0] - M_PI) > 0.1);
  return cycle;
}

/* A third of a symmetric cycle of six periods is one of two. */
TEST(test_a_third_of_a_symmetric_cycle) {
  const kz_atlas atlas = {.plane = PLANE};
  kz_cycle cycle = symmetric_cycle();
  cycle.kind.points = 3;
  for (int i = 1; i < 3; i++)
    cycle.point[i][0] = 2 * M_PI - cycle.point[i - 1][0], cycle.point[i][1] = -cycle.point[i - 1][1];
  assert_true(kz_atlas_reduce(&atlas, 1e-5, &cycle));
  assert_true(cycle.kind.points == 1 && cycle.kind.side == -1 && cycle.kind.multiplier == -1 && cycle.kind.turns == 1);
}

/* A file's row has a cycle's first point alone, angle in [-pi, pi]; the completed others close as its kind does. */
TEST(test_a_row_of_a_file_is_completed) {
  const kz_atlas atlas = {.plane = PLANE};
  kz_cycle cycle = symmetric_cycle();
  double *first = cycle.point[0];
  if (first[0] < M_PI) first[0] = 2 * M_PI - first[0], first[1] = -first[1]; /* its image */
  kz_cycle row = cycle;
  row.point[0][0] = remainder(first[0], 2 * M_PI);
  assert_true(row.point[0][0] < 0);
  kz_atlas_complete(&atlas, &row);
  assert_true(fabs(row.point[0][0] - first[0]) < 1e-12 && row.point[0][1] == first[1] && row.kind.turns == 1);
}

/* A cycle of three periods at its fold or its doubling in a band 3e-8 wide, told twice round, beside the place where it
 * is by the error of one. At the fold no such cycle may exist there; at the doubling its trace differs by 1e-3. */
TEST(test_twice_round_in_a_narrow_band) {
  static const struct {
    kz_cycle at;
    double beside;
  } of_three[] = {{{.kind = {1, 3, 1, 1},
                    .place = {-0.534401758096531, 1.299673584314393},
                    .point = {{-0.130013356382532, 0.102831005803898}}},
                   1e-13},
                  {{.kind = {1, 3, -1, 3},
                    .place = {-0.204525016945798, 1.341701909182105},
                    .point = {{-2.960795023656967, 2.511593812951067}}},
                   4e-12}};
  const kz_atlas atlas = {.plane = PLANE};
  for (int i = 0; i < 4; i++) {
    kz_cycle once = of_three[i / 2].at;
    assert_int_equal(kz_curve_orbit(&PLANE, once.place, 2, 2, once.point[0]), 1);
    assert_int_equal(kz_cycle_locate(&PLANE, &once, UP), 1);
    kz_cycle twice = once;
    twice.kind = (kz_cycle_kind){1, 6, 1, 2 * once.kind.turns};
    for (int p = 0; p < 3; p++) {
      twice.point[p + 3][0] = once.point[p][0] + 2 * M_PI * once.kind.turns;
      twice.point[p + 3][1] = once.point[p][1];
    }
    twice.place[1] += (i % 2 ? -1 : 1) * of_three[i / 2].beside;
    assert_true(kz_atlas_reduce(&atlas, 1e-5, &twice));
    assert_memory_equal(&twice.kind, &once.kind, sizeof once.kind);
  }
}

/* A record that is full says how many seeds it has no room for. */
TEST(test_a_full_record_counts_what_it_drops) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds seeds = {0};
  KZ_AUTOFREE char *record = kz_malloc(KZ_ATLAS_SEEDS_BYTES);
  const kz_cycle seed = {.kind = {1, 1}};
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
