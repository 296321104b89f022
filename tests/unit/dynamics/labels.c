/* Labels: mirrored starts, the processed splitting against split6, grown regions, errors beside the orbits. */
#include "../../tools/test.h"

#include "../../tools/explored.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Mirrored starts get mirrored labels and equal settling times; a cell outside the table is integrated, not guessed. */
TEST(test_mirrored_labels) {
  enum { N = 1000 };
  kz_dynamics *d = explored_dynamics(0.46, 1, 3);
  with_table(d, 400, 3);
  assert_true(kz_dynamics_trapped_share(d) > 0.2);
  double *x = malloc(2 * N * sizeof *x), *y = malloc(2 * N * sizeof *y);
  int32_t a[N], b[N];
  int64_t pa[N], pb[N];
  static const int ways[] = {KZ_FOLLOW_DIRECT, KZ_FOLLOW_LINEAR, KZ_FOLLOW_QUINTIC};
  for (int way = 0; way < 3; way++) {
    kz_window wide = {-M_PI, M_PI, -6, 6};
    kz_dynamics_starts(&wide, 5, N, x);
    for (int i = 0; i < 2 * N; i++) y[i] = -x[i];
    kz_dynamics_follow(d, ways[way], N, 2000, x, a, pa, NULL);
    kz_dynamics_follow(d, ways[way], N, 2000, y, b, pb, NULL);
    for (int i = 0; i < N; i++) {
      kz_attractor row;
      double theta[12], velocity[12];
      assert_true(a[i] > 0);
      kz_dynamics_attractor(d, a[i], &row);
      kz_dynamics_strobe(d, a[i], theta, velocity);
      assert_int_equal(b[i], row.mirror);
      assert_int_equal(pa[i], pb[i]);
    }
  }
  free(x);
  free(y);
  kz_dynamics_free(d);
}

/* The processed splitting as kz_numerics_choose finds it for a window and an error of a period. */
static kz_numerics labels_processed(double m, double tolerance) {
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, m};
  kz_numerics numerics = {0};
  double error;
  assert_int_equal(kz_numerics_choose(&pendulum, tolerance, 3, &numerics, &error), KZ_OK);
  return numerics;
}

/* Labels of one kick a step in coordinates of its own are those of split6 with 96 steps, but where the last place of a
 * start decides: at m = 0.46 that is so for 23 of 3072 starts. Grown over the cells of its own table they stay so; with
 * mirrored starts they are mirrored. The strobe points are the same to the last bit. */
TEST(test_processed) {
  enum { N = 3072 / PART };
  static const struct {
    double m;
    int most;
  } cases[] = {{0.3, 0}, {0.46, 88}};
  const kz_numerics fine = {.scheme = kz_scheme_find("split6"), .steps_per_period = 96};
  static double x[2 * N], y[2 * N], z[2 * N];
  static int32_t expected[N], label[N], mirrored[N], cells[N];
  static int64_t periods[N], late[N];
  if (PART > 1) return; /* the other tests of this file show the sanitizers the same code */
  for (int c = 0; c < 2; c++) {
    const kz_numerics numerics = labels_processed(cases[c].m, 1e-12);
    kz_dynamics *reference = explored_with(&fine, cases[c].m, 1, 0, 3),
                *d = explored_with(&numerics, cases[c].m, 1, 0, 3);
    int unlike = 0, unlike_cells = 0;
    assert_int_equal(kz_dynamics_count(d), kz_dynamics_count(reference));
    int64_t order[64], order_reference[64], rank[64] = {0};
    kz_dynamics_order(d, order);
    kz_dynamics_order(reference, order_reference);
    for (int64_t i = 0; i < kz_dynamics_count(d); i++) {
      kz_attractor row, same;
      double theta[2][12], velocity[2][12];
      rank[order[i]] = order_reference[i];
      kz_dynamics_attractor(d, order[i], &row);
      kz_dynamics_strobe(d, order[i], theta[0], velocity[0]);
      kz_dynamics_attractor(reference, order_reference[i], &same);
      kz_dynamics_strobe(reference, order_reference[i], theta[1], velocity[1]);
      assert_int_equal(row.period, same.period);
      for (int j = 0; j < row.period; j++) assert_true(fabs(velocity[0][j] - velocity[1][j]) < 1e-12);
      /* The product of the multipliers is the contraction of areas */
      const double product = row.multiplier_re[0] * row.multiplier_re[1] - row.multiplier_im[0] * row.multiplier_im[1];
      assert_true(fabs(product / exp(-2 * M_PI * row.period / 55) - 1) < 1e-9);
    }
    kz_dynamics_starts(&WINDOW, 3, N, x);
    memcpy(y, x, sizeof x);
    for (int i = 0; i < 2 * N; i++) z[i] = -x[i];
    kz_dynamics_follow(reference, KZ_FOLLOW_DIRECT, N, 2000, y, expected, periods, NULL);
    memcpy(y, x, sizeof x);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 2000, y, label, periods, NULL);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 2000, z, mirrored, late, NULL);
    with_table(d, PART > 1 ? 100 : 300, 3);
    memcpy(y, x, sizeof x);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 2000, y, cells, late, NULL);
    for (int i = 0; i < N; i++) {
      kz_attractor row;
      double theta[12], velocity[12];
      unlike += rank[label[i]] != expected[i];
      unlike_cells += cells[i] != label[i];
      assert_true(label[i] > 0 || mirrored[i] == 0); /* on an attractor that the search has missed */
      if (label[i] == 0) continue;
      kz_dynamics_attractor(d, label[i], &row);
      kz_dynamics_strobe(d, label[i], theta, velocity);
      assert_int_equal(mirrored[i], row.mirror);
    }
    print_message("m = %g: %d of %d labels unlike split6 with 96 steps, %d with grown regions\n", cases[c].m, unlike, N,
                  unlike_cells);
    assert_true(unlike <= cases[c].most / PART + 2);
    assert_true(unlike_cells == 0);
    kz_dynamics_free(reference);
    kz_dynamics_free(d);
  }
}

/* Starts inside grown regions end where the regions say: flown on with nothing but tiny ellipses of a fresh search.
 * Under a strong drive threads of other basins, narrower than a cell, pass between its corners. */
TEST(test_regions_are_right) {
  enum { N = 8000 / PART };
  static const kz_pendulum pendulums[] = {
      {1.0 / 121, 1.0 / 55, 0.15}, {1.0 / 121, 1.0 / 55, 0.46}, {0.04631, 0.1617, 1.353}};
  static double x[2 * N], y[2 * N];
  static int32_t label[N], expected[N];
  static int64_t periods[N], late[N];
  for (int c = 0; c < (PART > 1 ? 1 : 3); c++) {
    kz_dynamics *d = explored_pendulum(pendulums + c, fine_numerics(), 1, 0, 3.0),
                *plain = explored_pendulum(pendulums + c, fine_numerics(), 1, 0, 3.0);
    kz_dynamics_regions(d, PART > 1 ? 200 : 400, 3.0);
    int inside = 0;
    kz_dynamics_starts(&WINDOW, 9, N, x);
    memcpy(y, x, sizeof y);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 1, x, label, periods, NULL);
    kz_dynamics_follow(plain, KZ_FOLLOW_DIRECT, N, 3000, y, expected, late, NULL);
    for (int i = 0; i < N; i++) {
      if (label[i] == 0 || periods[i] > 0) continue;
      inside++;
      assert_int_equal(label[i], expected[i]);
    }
    print_message("m = %.2f: %d of %d starts inside, none wrong\n", pendulums[c].m, inside, N);
    assert_true(inside > N / 20);
    kz_dynamics_free(d);
    kz_dynamics_free(plain);
  }
}

/* With its error beside it an orbit ends where it ends alone, or its label is doubtful: every wrong one is (quad
 * precision), and hardly six times as many as are wrong. */
TEST(test_wrong_labels_are_doubtful) {
  enum { N = 4000 / PART };
  static double start[2 * N], x[2 * N], y[2 * N];
  static int32_t direct[N], followed[N], expected[N];
  static int64_t periods[N];
  kz_dynamics *d = explored_dynamics(0.46, 1, 3);
  with_table(d, 400, 3);
  int wrong = 0, doubtful = 0;
  kz_dynamics_starts(&WINDOW, 3, N, x);
  for (int i = 0; i < 2 * N; i++) start[i] = i % 2 ? x[i] : x[i] * M_PI;
  memcpy(y, x, sizeof x);
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 2000, x, direct, periods, NULL);
  label_starts(d, next_cheaper(KZ_LEVEL_DOUBLE), N, start, followed);
  label_starts(d, (kz_label_precision){.level = KZ_LEVEL_QUAD, .series_steps = KZ_REFERENCE_STEPS}, N, start, expected);
  for (int i = 0; i < N; i++) {
    doubtful += followed[i] == KZ_DOUBTFUL;
    wrong += expected[i] != direct[i];
    if (followed[i] == KZ_DOUBTFUL) continue;
    assert_int_equal(followed[i], direct[i]);
    assert_int_equal(followed[i], expected[i]);
  }
  print_message("%d of %d labels wrong, %d doubtful\n", wrong, N, doubtful);
  assert_true(wrong > N / 100 && doubtful < 6 * wrong);
  int open = 0; /* a finer level decides nearly all that this one leaves */
  for (int i = 0; i < N && open < 64; i++) {
    if (followed[i] != KZ_DOUBTFUL) continue;
    expected[open] = expected[i];
    memmove(start + 2 * open++, start + 2 * i, 2 * sizeof *start);
  }
  label_starts(d, next_cheaper(KZ_LEVEL_PAIRS_28), open, start, direct);
  label_starts(d, next_cheaper(KZ_LEVEL_QUAD), open, start, followed);
  doubtful = 0;
  for (int i = 0; i < open; i++) doubtful += followed[i] == KZ_DOUBTFUL;
  for (int i = 0; i < open; i++) assert_true(followed[i] == expected[i] || followed[i] == KZ_DOUBTFUL);
  assert_in_range(doubtful, 0, 4);
  for (int i = 0; i < open; i++) assert_true(direct[i] == followed[i] || direct[i] == KZ_DOUBTFUL);
  for (int i = 0; i < open; i++) doubtful -= direct[i] == KZ_DOUBTFUL;
  assert_in_range(-doubtful, 0, 4);
  kz_dynamics_free(d);
}

/* Items that have passed through the pairs of doubles are decided where quad precision alone decides them. */
TEST(test_quads_decide_after_pairs_what_they_decide_alone) {
  enum { N = 100000 };
  static double x[2 * N];
  static kz_start start[N];
  static kz_decision decision[N], alone[N];
  int64_t left = N;
  int decided = 0;
  if (PART > 1) return; /* other tests show the sanitizers the same code */
  kz_dynamics *d = explored_dynamics(0.46, 1, 3);
  kz_dynamics_regions(d, 400, 3);
  kz_dynamics_starts(&WINDOW, 3, N, x);
  for (int i = 0; i < N; i++) start[i] = (kz_start){.theta = {x[2 * i] * M_PI, 0}, .velocity = {x[2 * i + 1], 0}};
  for (kz_precision level = KZ_LEVEL_DOUBLE; level <= KZ_LEVEL_PAIRS_28; level++) {
    const int64_t n = left;
    const kz_label_precision precision = next_cheaper(level);
    kz_dynamics_label(d, &precision, n, start, 2000, decision);
    left = 0;
    for (int64_t i = 0; i < n; i++)
      if (decision[i].end.label == KZ_DOUBTFUL) start[left++] = start[i];
  }
  kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_QUAD, .before = KZ_LEVEL_FINE}, left, start, 2000,
                    alone);
  kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_QUAD, .before = KZ_LEVEL_PAIRS_28}, left, start, 2000,
                    decision);
  for (int64_t i = 0; i < left; i++) {
    assert_int_equal(decision[i].end.label, alone[i].end.label);
    decided += alone[i].end.label != KZ_DOUBTFUL;
  }
  print_message("quads decide %d of %d\n", decided, (int)left);
  assert_true(decided > 0 && decided < left);
  kz_dynamics_free(d);
}

/* The whole error ellipse of a decided orbit lies in the region, not its state alone: both ends of the longest
 * diameter, along which the tangents have stretched the error, do. A label shows no difference here, since regions lie
 * within their basins. */
TEST(test_regions_hold_whole_ellipses) {
  enum { N = 4096 };
  static double x[2 * N], ends[4 * N];
  static kz_start starts[N];
  static kz_decision decision[N];
  static int32_t label[2 * N], expected[2 * N];
  static int64_t periods[2 * N];
  int64_t n = 0, turns = 0;
  if (PART > 1) return; /* other tests show the sanitizers the same code */
  kz_dynamics *d = explored_dynamics(0.46, 1, 3);
  with_table(d, 400, 3);
  kz_flow *flow = kz_flow_create(&(kz_pendulum){1.0 / 121, 1.0 / 55, 0.46}, fine_numerics());
  kz_dynamics_starts(&WINDOW, 3, N, x);
  for (int i = 0; i < N; i++) starts[i] = (kz_start){.theta = {x[2 * i] * M_PI}, .velocity = {x[2 * i + 1]}};
  kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_DOUBLE}, N, starts, 2000, decision);
  for (int i = 0; i < N; i++) {
    if (decision[i].end.label <= 0 || decision[i].error < 1e-4) continue;
    double theta = starts[i].theta[0], velocity = starts[i].velocity[0], j[4];
    kz_advance_tangent(flow, 1, decision[i].age, &theta, &velocity, &turns, j);
    const int column = hypot(j[1], j[3]) > hypot(j[0], j[2]);
    const double stretched = hypot(j[column], j[2 + column]);
    for (int side = -1; side <= 1; side += 2, n++) {
      ends[2 * n] = decision[i].state[0] + side * 0.9 * decision[i].error * j[column] / stretched / M_PI;
      ends[2 * n + 1] = decision[i].state[1] + side * 0.9 * decision[i].error * j[2 + column] / stretched;
      expected[n] = decision[i].end.label;
    }
  }
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, n, 1, ends, label, periods, NULL);
  int held = 0;
  for (int64_t i = 0; i < n; i++) held += label[i] == expected[i] && periods[i] == 0;
  print_message("%d of %d ends of ellipses held\n", held, (int)n);
  assert_true(n > 300 && held + n / 100 >= n); /* the rim of an ellipse is tried on eight points */
  kz_flow_free(flow);
  kz_dynamics_free(d);
}

/* Error growth foretells the level that decides a doubtful orbit: a skipped level would decide hardly one. */
TEST(test_growth_foretells_the_level) {
  enum { N = 1500 };
  static double x[2 * N];
  static kz_start start[N], left[2][N];
  static kz_decision decision[N];
  const kz_numerics numerics = labels_processed(0.46, 1e-13);
  int64_t n[2] = {0};
  if (PART > 1) return; /* other tests show the sanitizers the same code */
  kz_dynamics *d = explored_with(&numerics, 0.46, 1, 0, 3);
  with_table(d, 400, 3);
  kz_dynamics_starts(&WINDOW, 3, N, x);
  for (int i = 0; i < N; i++) start[i] = (kz_start){.theta = {x[2 * i] * M_PI, 0}, .velocity = {x[2 * i + 1], 0}};
  kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_DOUBLE}, N, start, 2000, decision);
  for (int i = 0; i < N; i++) {
    const int skips = decision[i].end.next == KZ_LEVEL_PAIRS_20;
    if (decision[i].end.label != KZ_DOUBTFUL) continue;
    assert_true(skips || decision[i].end.next == KZ_LEVEL_PAIRS_16);
    left[skips][n[skips]++] = start[i];
  }
  assert_true(n[0] > 20 && n[1] > 20);
  for (int skips = 0; skips < 2; skips++) {
    int64_t decided = 0;
    kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_PAIRS_16}, n[skips], left[skips], 2000, decision);
    for (int64_t i = 0; i < n[skips]; i++) decided += decision[i].end.label != KZ_DOUBTFUL;
    print_message("%d of %d decided\n", (int)decided, (int)n[skips]);
    assert_true(skips ? 10 * decided <= n[skips] : 2 * decided > n[skips]);
  }
  kz_dynamics_free(d);
}

/* Whole turns of motions without rotation, from the start to down or inverted, by an integrator's angles. */
TEST(test_turns_are_those_of_the_angle) {
  enum { N = 512, LEVELS = 4, LATER = 600 };
  static const kz_precision levels[LEVELS] = {KZ_LEVEL_DOUBLE, KZ_LEVEL_FINE, KZ_LEVEL_PAIRS_20, KZ_LEVEL_QUAD};
  static double x[2 * N];
  static kz_start start[2 * N];
  static kz_decision decision[LEVELS][2 * N];
  int counted = 0, turned = 0;
  if (PART > 1) return; /* other tests show the sanitizers the same code */
  kz_dynamics *d = explored_dynamics(0.3, 1, 3);
  kz_dynamics_regions(d, 400, 3);
  kz_flow *flow = kz_flow_create(&(kz_pendulum){1.0 / 121, 1.0 / 55, 0.3}, fine_numerics());
  kz_dynamics_starts(&WINDOW, 3, N, x);
  for (int i = 0; i < N; i++) { /* some are given a turn too far */
    start[i] = (kz_start){.theta = {x[2 * i] * M_PI + (i % 8 ? 0 : 2 * M_PI)}, .velocity = {x[2 * i + 1]}};
    start[N + i] = (kz_start){.theta = {-start[i].theta[0]}, .velocity = {-start[i].velocity[0]}};
  }
  for (int l = 0; l < LEVELS; l++) {
    const kz_label_precision precision = next_cheaper(levels[l]);
    kz_dynamics_label(d, &precision, 2 * N, start, 2000, decision[l]);
    kz_dynamics_count_turns(d, 2 * N, 2000, decision[l]);
  }
  for (int i = 0; i < N; i++) {
    double theta = start[i].theta[0], velocity = start[i].velocity[0];
    int64_t turns = 0;
    kz_attractor row = {.winding = 1};
    if (decision[0][i].end.label <= 0) continue;
    kz_dynamics_attractor(d, decision[0][i].end.label, &row);
    kz_advance(flow, 1, LATER, &theta, &velocity, &turns);
    const double end = M_PI * rint(theta / M_PI) + 2 * M_PI * (double)turns;
    const int expected = row.winding == 0 ? (int)rint((end - start[i].theta[0]) / (2 * M_PI)) : KZ_NO_TURNS;
    for (int l = 0; l < LEVELS; l++) {
      if (decision[l][i].end.label <= 0) continue;
      assert_int_equal(decision[l][i].end.turns, expected);
      assert_int_equal(decision[l][N + i].end.turns, expected == KZ_NO_TURNS ? expected : -expected);
    }
    counted += expected != KZ_NO_TURNS;
    turned += expected != KZ_NO_TURNS && expected != 0;
  }
  print_message("%d of %d end on no rotation, %d of them turn\n", counted, N, turned);
  assert_true(turned > 40 && counted > turned + 40 && counted < N);
  kz_flow_free(flow);
  kz_dynamics_free(d);
}
