/* The smallest shocks over label fields whose boundaries are known. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "../../tools/test.h"

#include "resilience/resilience.h"

static int64_t labels; /* Number of labels that were asked for */

/* Another label inside an ellipse about (2, 1), below v = -1.7, in a small disc, in a thin strip at theta = -2.5. */
static int16_t end_at(double theta, double velocity, bool small) {
  if (hypot((theta - 2) / 2, velocity - 1) < 0.5) return 2;
  if (velocity < -1.7) return 3;
  if (small && hypot(theta - 0.6, velocity + 0.5) < 0.03) return 4;
  return theta < -2.5 && theta > -2.51 ? 5 : 1;
}

static void shocks_ends(void *context, int64_t n, const double *start, kz_label *end) {
  const bool *small = context;
  labels += n;
  for (int64_t i = 0; i < n; i++)
    end[i] = (kz_label){.label = end_at(start[2 * i], start[2 * i + 1], *small), .periods = 3};
}

/* The distance of the ellipse from the origin in the norm of `scale`, by brute force. */
static double ellipse_distance(double scale) {
  double least = INFINITY;
  for (int i = 0; i < 4000000; i++) {
    const double angle = 2 * M_PI * i / 4000000;
    least = fmin(least, hypot(2 + cos(angle), (1 + sin(angle) / 2) / scale));
  }
  return least;
}

TEST(test_lines_and_discs) {
  bool small = false;
  kz_shock_problem problem = {.ends = shocks_ends, .context = &small, .own = 1, .scale = 1, .farthest = 3};
  kz_shock shock[3];
  kz_shocks_find(&problem, shock);
  assert_true(fabs(shock[0].theta + 2.5) < 1e-11 && shock[0].velocity == 0 && shock[0].end == 5);
  assert_true(fabs(shock[1].velocity + 1.7) < 1e-11 && shock[1].theta == 0 && shock[1].end == 3);
  assert_true(fabs(shock[2].size - ellipse_distance(1)) < 1e-10 && shock[2].end == 2);
  assert_true(fabs(hypot(shock[2].theta, shock[2].velocity) - shock[2].size) < 1e-14);
  problem.scale = 0.5;
  kz_shocks_find(&problem, shock);
  assert_true(fabs(shock[2].size - ellipse_distance(0.5)) < 1e-10);
  small = true;
  problem.scale = 1;
  kz_shocks_find(&problem, shock);
  assert_true(fabs(shock[2].size - (hypot(0.6, 0.5) - 0.03)) < 1e-10 && shock[2].end == 4);
}

/* The other rest, half a turn from a rest, on which only the very start stays. */
static void ends_but_the_rest(void *context, int64_t n, const double *start, kz_label *end) {
  (void)context;
  for (int64_t i = 0; i < n; i++)
    end[i] = (kz_label){.label = fabs(start[2 * i]) == M_PI && start[2 * i + 1] == 0 ? 0 : 1};
}

TEST(test_the_other_rest_is_no_basin) {
  const kz_shock_problem problem = {.ends = ends_but_the_rest, .own = 1, .scale = 1, .farthest = 2};
  kz_shock shock[3];
  kz_shocks_find(&problem, shock);
  for (int i = 0; i < 3; i++) assert_true(isnan(shock[i].size) && shock[i].end == -1);
}

/* Smooth boundaries to the tolerance by far fewer labels; a smaller one within the known, none where none is. */
TEST(test_a_tolerance) {
  bool small = false;
  kz_shock_problem problem = {.ends = shocks_ends, .context = &small, .own = 1, .scale = 1, .farthest = 3};
  kz_shock shock[3], known = {1.95, 0, 1.95, 2}, none = {0.5, 0, 0.5, 2};
  const double distance = ellipse_distance(1);
  labels = 0;
  kz_shocks_find(&problem, shock);
  const int64_t closely = labels;
  for (int i = 0; i < 3; i++) {
    problem.tolerance = (double[]){0.02, 0.004, 1e-4}[i];
    labels = 0;
    kz_shocks_find(&problem, shock);
    assert_true(fabs(shock[2].size / distance - 1) < problem.tolerance && shock[2].end == 2);
    assert_true(fabs(shock[1].size / 1.7 - 1) < problem.tolerance);
    assert_true(problem.tolerance < 1e-3 || labels < closely / 20);
  }
  kz_shocks_nearer(&problem, &known);
  assert_true(fabs(known.size / distance - 1) < problem.tolerance && known.end == 2);
  kz_shocks_nearer(&problem, &none);
  assert_true(none.size == 0.5 && none.theta == 0.5);
}

TEST(test_nothing_to_find) {
  bool small = false;
  const kz_shock_problem problem = {
      .ends = shocks_ends, .context = &small, .from = {0, 40}, .own = 1, .scale = 1, .farthest = 1};
  kz_shock shock[3];
  kz_shocks_find(&problem, shock);
  assert_true(fabs(shock[0].size - 2.5) < 1e-11 && isnan(shock[1].size) && isnan(shock[1].velocity) &&
              shock[1].end == -1);
  assert_true(fabs(shock[2].size - 2.5) < 1e-10);
}

/* The share of shocks of at most 1.4 that ends below v = -1.7 is a circular segment. */
TEST(test_share_of_harmless_shocks) {
  bool small = false;
  const kz_shock_problem problem = {
      .ends = shocks_ends, .context = &small, .from = {-0.5, -0.5}, .own = 1, .scale = 1, .farthest = 3};
  kz_harmless harmless;
  kz_shocks_harmless(&problem, 1.4, &harmless);
  const double half = acos(1.2 / 1.4), segment = (half - sin(half) * cos(half)) / M_PI;
  assert_true(fabs(1 - segment - (double)harmless.harmless / (double)harmless.shocks) < 2e-3 &&
              harmless.return_time == 3);
}
