/* Shares and intervals, Pareto fronts, orders of cost and of sampled cells, the table of configurations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/test.h"

#include "accuracy/accuracy.h"
#include "numerics/share.h"
#include "kapitza/study_basin.h"

/* Wilson's limits solve (share - p)^2 = z^2 p (1 - p)/n. */
TEST(test_wilson_solves_its_equation) {
  const int64_t cases[][2] = {{0, 10}, {1, 10}, {5, 10}, {10, 10}, {3, 4000}, {123, 456}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const double n = (double)cases[i][1], z = 1.959963984540054;
    const kz_share s = kz_share_of(cases[i][0], cases[i][1]);
    assert_true(s.share == (double)cases[i][0] / n && s.low <= s.share && s.share <= s.high);
    const double ends[] = {s.low, s.high};
    for (int e = 0; e < 2; e++) {
      if ((e == 0 && s.share == 0) || (e == 1 && s.share == 1)) continue;
      const double p = ends[e];
      assert_true(fabs((s.share - p) * (s.share - p) - z * z * p * (1 - p) / n) < 1e-12);
    }
  }
  assert_true(kz_share_of(0, 0).low == 0 && kz_share_of(0, 0).high == 1);
}

/* Half of a population leaves half of the variance, all of it none, and a large one is like no end of cells. */
TEST(test_part_of_a_population) {
  const double z = 1.959963984540054;
  const kz_share half = kz_share_of_part(30, 500, 1000), all = kz_share_of_part(3, 40, 40),
                 of_many = kz_share_of_part(30, 500, INT64_MAX);
  const double p = half.high, square = z * z * 500 / 999;
  assert_true(fabs((half.share - p) * (half.share - p) - square * p * (1 - p) / 500) < 1e-12);
  assert_true(all.low == 3.0 / 40 && all.share == all.low && all.high == all.low);
  assert_true(fabs(of_many.high - kz_share_of(30, 500).high) < 1e-12);
  assert_true(kz_share_of_part(0, 0, 0).low == 0 && kz_share_of_part(0, 0, 0).high == 1);
}

TEST(test_smallest_sample_proves_its_share) {
  assert_int_equal(kz_share_sample(0.001), 3838);
  for (double share = 0.5; share > 1e-4; share /= 3) {
    const int64_t n = kz_share_sample(share);
    assert_true(kz_share_of(0, n).high <= share);
    assert_true(kz_share_of(0, n - 1).high > share);
  }
}

TEST(test_shuffled_cells_are_a_permutation) {
  const int64_t totals[] = {1, 2, 3, 5, 16, 17, 1000, 10007};
  for (size_t t = 0; t < sizeof totals / sizeof *totals; t++) {
    char *seen = calloc((size_t)totals[t], 1);
    assert_non_null(seen);
    for (int64_t i = 0; i < totals[t]; i++) {
      const int64_t cell = kz_shuffled(i, totals[t], 7);
      assert_in_range(cell, 0, totals[t] - 1);
      assert_int_equal(seen[cell], 0);
      seen[cell] = 1;
    }
    free(seen);
  }
}

/* A sample looks random: every quarter of the cells gets its share, and another seed chooses others. */
TEST(test_shuffled_cells_spread) {
  int quarter[4] = {0}, same = 0;
  for (int64_t i = 0; i < 4000; i++) {
    quarter[4 * kz_shuffled(i, 1000000, 1) / 1000000]++;
    same += kz_shuffled(i, 1000000, 1) == kz_shuffled(i, 1000000, 2);
  }
  for (int q = 0; q < 4; q++) assert_in_range(quarter[q], 880, 1120);
  assert_in_range(same, 0, 3);
}

TEST(test_settings_differ_and_exist) {
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  const kz_basin_plan plan = {.theta = {-M_PI, M_PI, 10}, .velocity = {-2, 2, 10}};
  for (int i = 0; i < kz_setting_count; i++) {
    assert_true(kz_setting_numerics(kz_settings + i, &pendulum, NULL, &plan).scheme < kz_scheme_count());
    assert_non_null(strstr(kz_tradeoff_words(), kz_settings[i].label));
    for (int j = 0; j < i; j++) assert_string_not_equal(kz_settings[i].label, kz_settings[j].label);
  }
}

/* More cells, more periods, more steps and more nodes never cost less. */
TEST(test_cost_grows) {
  for (int i = 0; i < kz_setting_count; i++) {
    kz_setting more = kz_settings[i];
    const double cost = kz_setting_cost(&more, 1e6, 10);
    assert_true(kz_setting_cost(&more, 2e6, 10) > cost && kz_setting_cost(&more, 1e6, 20) > cost);
    more.steps *= 2;
    more.tolerance /= 16;
    assert_true(kz_setting_cost(&more, 1e6, 10) > cost);
  }
}

/* Chao's estimate: 34 kinds seen once and 29 twice of 183 leave 19 unseen, of 203; none seen once leave none. */
TEST(test_the_number_of_kinds_that_nobody_saw) {
  double low, high;
  const kz_unseen unseen = kz_unseen_of(34, 29);
  assert_true(fabs(unseen.number - 34. * 33 / 60) < 1e-12);
  kz_unseen_interval(unseen, &low, &high);
  assert_true(fabs(low - 8) < 0.1 && fabs(high - 43.8) < 0.5);
  kz_unseen_interval(kz_unseen_of(0, 12), &low, &high);
  assert_true(low == 0 && high == 0);
}
