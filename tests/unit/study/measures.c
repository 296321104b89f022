/* Every measure on starts and pictures with a known answer: half planes, a disc, random labels, a shear. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/test.h"

#include "numerics/counts.h"
#include "measures/measures.h"
#include "measures/picture.h"

enum { CELLS = 200, MOST = 4 };

/* A picture over [-half, half] x [-1, 1] of labels by `label`, with attractors of period 1 at `at` [n]. */
typedef struct {
  kz_measures_plan plan;
  kz_entry entry[MOST];
  double theta[MOST], velocity[MOST];
  int16_t id[CELLS * CELLS];
  kz_measured measured;
} scene;

typedef int16_t (*label_fn)(double theta, double velocity, int64_t cell);

static scene *measures_make(int n, double half, label_fn label) {
  scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->plan = (kz_measures_plan){.theta = {.min = -half, .max = half},
                               .velocity = {.min = -1, .max = 1},
                               .options = {.cells = CELLS, .shock_scale = 1, .within = 10}};
  for (int i = 0; i < n; i++)
    s->entry[i] = (kz_entry){.row = {.period = 1}, .theta = s->theta + i, .velocity = s->velocity + i};
  for (int64_t i = 0; label && i < CELLS * CELLS; i++)
    s->id[i] = label((i % CELLS * 2 + 1 - CELLS) * half / CELLS, (double)(i / CELLS * 2 + 1 - CELLS) / CELLS, i);
  s->measured = (kz_measured){.plan = &s->plan, .catalogue = {.count = n, .entries = s->entry}};
  s->measured.picture = (kz_ended){.n = CELLS * CELLS, .id = s->id};
  return s;
}

static int16_t left_half(double theta, double velocity, int64_t cell) {
  (void)velocity, (void)cell;
  return theta >= 0;
}

static int16_t measures_disc(double theta, double velocity, int64_t cell) {
  (void)cell;
  return hypot(theta - 0.2, velocity) >= 0.5;
}

static int16_t measures_middle(double theta, double velocity, int64_t cell) {
  (void)velocity, (void)cell;
  return fabs(theta) < 0.3;
}

static uint64_t measures_mixed(int64_t cell) {
  uint64_t x = (uint64_t)cell * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  return (x ^ (x >> 27)) >> 33;
}

static int16_t two_at_random(double theta, double velocity, int64_t cell) {
  (void)theta, (void)velocity;
  return (int16_t)(measures_mixed(cell) % 2);
}

static int16_t three_at_random(double theta, double velocity, int64_t cell) {
  (void)theta, (void)velocity;
  return (int16_t)(measures_mixed(cell) % 3);
}

static const double STEP = 2.0 / CELLS;

TEST(test_half_plane) {
  scene *s = measures_make(2, 1, left_half);
  double value[3 * MOST];
  s->theta[0] = -0.2;
  s->theta[1] = 0.7;
  kz_measure_integrity_local(&s->measured, value);
  assert_true(fabs(value[0] - 0.2) <= STEP && fabs(value[1] - 0.3) <= STEP); /* 0.3 to the edge of the picture */
  kz_measure_integrity_factor(&s->measured, value);
  assert_true(fabs(value[0] - 0.5) <= STEP && fabs(value[1] - 0.5) <= STEP);
  kz_measure_integrity_global(&s->measured, value);
  assert_true(fabs(value[0] - 2) < 1e-12 && fabs(value[1] - 2) < 1e-12);
  kz_measure_uncertainty_exponent(&s->measured, value);
  assert_true(fabs(value[0] - 1) < 0.05 && value[2] <= value[0] && value[0] <= value[4]);
  kz_measure_boundary_dimension(&s->measured, value);
  assert_true(fabs(value[0] - 1) < 0.05 && value[2] <= value[0] && value[0] <= value[4]);
  kz_measure_entropy(&s->measured, value);
  kz_measure_boundary_entropy(&s->measured, value + 1);
  assert_true(value[0] == 0 && value[1] == 0); /* the boundary falls between two boxes */
  kz_measure_shared_boundary(&s->measured, value);
  kz_measure_wada_on_grid(&s->measured, value + 2);
  assert_true(value[0] == 1 && value[1] == 1 && value[2] == 0); /* two basins are no Wada basins */
  s->velocity[0] = 3;
  kz_measure_integrity_local(&s->measured, value);
  assert_true(isnan(value[0]) && !isnan(value[1]));
  free(s);
}

TEST(test_disc_in_another_norm) {
  scene *s = measures_make(2, 1, measures_disc);
  double value[3 * MOST];
  s->theta[0] = 0.2;
  kz_measure_integrity_local(&s->measured, value);
  assert_true(fabs(value[0] - 0.5) <= STEP);
  kz_measure_integrity_factor(&s->measured, value);
  assert_true(fabs(value[0] - 0.5) <= 1.5 * STEP);              /* the centre is between four cells */
  assert_true(fabs(value[1] - (5.4 - sqrt(20.4)) / 2) <= STEP); /* in a corner: r^2 - 5.4 r + 2.19 = 0 */
  kz_measure_integrity_global(&s->measured, value);
  assert_true(fabs(value[0] - M_PI / 4) < 0.01);
  s->plan.options.shock_scale = 2; /* the disc becomes an ellipse of half the height */
  kz_measure_integrity_local(&s->measured, value);
  assert_true(fabs(value[0] - 0.25) <= STEP);
  kz_measure_integrity_global(&s->measured, value);
  assert_true(fabs(value[0] - M_PI / 4) < 0.01);
  free(s);
}

/* The basin of 0 goes through the seam of the circle. */
TEST(test_circles_go_around) {
  scene *s = measures_make(2, M_PI, measures_middle);
  double value[MOST];
  s->plan.velocity = (kz_axis){.min = -10, .max = 10};
  s->theta[0] = M_PI - 0.01;
  kz_measure_integrity_local(&s->measured, value);
  assert_true(fabs(value[0] - (M_PI - 0.31)) <= 2 * M_PI / CELLS + 0.1);
  kz_measure_integrity_factor(&s->measured, value);
  assert_true(fabs(value[0] - (M_PI - 0.3)) <= 0.1 && fabs(value[1] - 0.3) <= 0.05);
  free(s);
}

/* Newton's method for the roots of z^3 = 1: on which it ends. */
static int16_t measures_newton(double theta, double velocity, int64_t cell) {
  double complex z = CMPLX(theta, velocity);
  (void)cell;
  for (int i = 0; i < 100; i++) z -= (z * z * z - 1) / (3 * z * z);
  return creal(z) > 0 ? 0 : cimag(z) > 0 ? 1 : 2;
}

/* The map of C. Grebogi, S. W. McDonald, E. Ott, J. A. Yorke (Phys. Lett. A 99 (1983) 415), theta in [0, 2 pi), x in
 * [-0.5, 0.5]: it ends at theta = 0 or pi. */
static int16_t measures_grebogi(double theta, double velocity, int64_t cell) {
  double angle = theta + M_PI, x = velocity / 2;
  (void)cell;
  for (int i = 0; i < 300; i++) {
    const double next = angle + 1.32 * sin(2 * angle) - 0.9 * sin(4 * angle) - x * sin(angle);
    x = -0.3 * cos(angle);
    angle = next;
  }
  return cos(angle) > 0;
}

/* Maps that the tests of Attractors.jl use (test/basins/uncertainty_tests.jl): exponents 0.55 to 0.65 (dimension 1.42)
 * and 0.2 to 0.3 (0.2 in the paper), entropies 0.40 to 0.42 and 0.60 to 0.61 in boxes of 6 x 6 of 300 x 300 cells. */
TEST(test_published_maps) {
  scene *roots = measures_make(3, 1, measures_newton), *map = measures_make(2, M_PI, measures_grebogi);
  double value[3 * MOST];
  kz_measure_uncertainty_exponent(&roots->measured, value);
  const double exponent = (value[0] + value[1] + value[2]) / 3;
  assert_true(0.55 <= exponent && exponent <= 0.65 && fabs(2 - exponent - 1.42) < 0.03);
  kz_measure_uncertainty_exponent(&map->measured, value);
  assert_true(fabs(value[0] - 0.2) < 0.02 && fabs(value[1] - value[0]) < 1e-12);
  kz_measure_entropy(&map->measured, value);
  kz_measure_boundary_entropy(&map->measured, value + 1);
  assert_true(0.4 <= value[0] && value[0] <= 0.42);
  assert_true(0.59 <= value[1] && value[1] <= 0.61);
  free(roots);
  free(map);
}

TEST(test_riddled) {
  scene *two = measures_make(2, 1, two_at_random), *three = measures_make(3, 1, three_at_random);
  double value[3 * MOST];
  kz_measure_uncertainty_exponent(&two->measured, value);
  assert_true(fabs(value[0]) < 0.01);
  kz_measure_boundary_dimension(&two->measured, value);
  assert_true(fabs(value[0] - 2) < 0.01);
  kz_measure_entropy(&two->measured, value);
  kz_measure_boundary_entropy(&two->measured, value + 1);
  assert_true(fabs(value[0] - (M_LN2 - 1.0 / 50)) < 0.005 && value[1] == value[0]); /* 25 cells: about 1/(2 25) less */
  kz_measure_integrity_factor(&two->measured, value);
  assert_true(value[0] < 5 * STEP);
  kz_measure_wada_on_grid(&two->measured, value);
  kz_measure_wada_on_grid(&three->measured, value + 1);
  assert_true(value[0] == 0 && value[1] == 1);
  free(two);
  free(three);
}

/* Cells beyond the last whole box of 5 x 5 have a box of their own. */
TEST(test_entropies_hold_every_cell) {
  int16_t id[64 * 33];
  for (int i = 0; i < 64 * 33; i++) id[i] = i % 64 == 63 && i / 64 % 2; /* labels are mixed in the last column alone */
  kz_counts counts = {0};
  double entropy, boundary;
  int64_t cells = 0, boxes = 0;
  kz_count_boxes(64, 33, id, &counts);
  for (int n = 1; n <= KZ_BOX_CELLS; n++) {
    cells += n * counts.boxes[n];
    boxes += counts.boxes[n];
  }
  assert_true(cells == 64 * 33 && boxes == 13 * 7 && counts.boxes[12] == 1);
  kz_entropy_of(&counts, &entropy, &boundary);
  assert_true(boundary > 0.3 && fabs(entropy - boundary / 13) < 1e-14);
}

/* Three basins meet in the last column and row of a picture that boxes of 16 cells do not fill. */
TEST(test_boxes_of_shared_boundaries_hold_every_cell) {
  scene *s = measures_make(3, 1, NULL);
  double value[MOST];
  for (int i = 1; i < CELLS; i += 2) {
    s->id[i * CELLS + CELLS - 1] = 1;
    s->id[(CELLS - 1) * CELLS + i] = 2;
  }
  kz_measure_shared_boundary(&s->measured, value);
  assert_true(value[0] == 1 && value[1] == 13.0 / 25 && value[2] == 13.0 / 25);
  kz_measure_wada_on_grid(&s->measured, value);
  assert_true(value[0] == 0);
  free(s);
}

TEST(test_distances_are_those_of_brute_force) {
  enum { N = 23 };
  int16_t id[N * N];
  double distance[N * N];
  for (int i = 0; i < N * N; i++) id[i] = measures_mixed(i) % 7 == 0;
  for (int circle = 0; circle < 2; circle++) {
    const kz_picture picture = {N, N, 0.3, 0.7, circle, id};
    kz_picture_distances(&picture, 0, distance);
    for (int i = 0; i < N * N; i++) {
      double least = INFINITY;
      for (int row = 0; row < N; row++)
        for (int column = -N; column < 2 * N; column++) {
          const bool outside = !circle && (column < 0 || column >= N);
          if (outside || id[row * N + (column + N) % N] == 0) continue;
          least = fmin(least, hypot(0.3 * (column - i % N), 0.7 * (row - i / N)));
        }
      const double up = 0.7 * (fmin(i / N, N - 1 - i / N) + 0.5), across = 0.3 * (fmin(i % N, N - 1 - i % N) + 0.5);
      const double edge = circle ? up : fmin(up, across); /* where the window ends */
      assert_true(fabs(distance[i] - (least > 0 ? fmin(least - 0.15, edge) : 0)) < 1e-12);
    }
  }
}

TEST(test_shares_and_times) {
  const int16_t id[] = {0, 1, 0, -1, 0, 1, 1, 0};
  const uint32_t time[] = {4, 20, 6, 99, 10, 2, 8, 40};
  scene *s = measures_make(3, 1, NULL);
  double value[3 * MOST];
  s->measured.starts = s->measured.weighted = (kz_ended){.n = 8, .id = id, .time = time};
  kz_measure_share(&s->measured, value);
  assert_true(value[0] == 0.5 && value[1] == 3.0 / 8 && value[2] == 0 && value[3] < 0.5 && value[6] > 0.5);
  kz_measure_share_within(&s->measured, value);
  assert_true(value[0] == 3.0 / 8 && value[1] == 2.0 / 8);
  kz_measure_weighted_share(&s->measured, value);
  assert_true(value[0] == 0.5);
  kz_measure_settling_mean(&s->measured, value);
  assert_true(value[0] == 15 && value[1] == 10 && isnan(value[2]));
  kz_measure_settling_median(&s->measured, value);
  assert_true(value[0] == 8 && value[1] == 8 && isnan(value[2]));
  kz_measure_settling_largest(&s->measured, value);
  assert_true(value[0] == 40 && value[1] == 20 && isnan(value[2]));
  free(s);
}

TEST(test_pace) {
  const int16_t id[] = {0, 0, -1, 0};
  const uint32_t time[] = {6, 20, 9, 0};
  const double start[] = {0, 0.5, M_PI + 0.3, 0, 1, 1, 0.4, 0.2}; /* the last: a strobe point */
  scene *s = measures_make(2, 1, NULL);
  double value[MOST];
  s->theta[0] = 0.4;
  s->velocity[0] = 0.2;
  s->measured.starts = (kz_ended){.n = 4, .start = start, .id = id, .time = time};
  kz_measure_settling_pace(&s->measured, value);
  assert_true(fabs(value[0] - (6 / 0.5 + 20 / hypot(M_PI - 0.1, 0.2)) / 3) < 1e-12 && isnan(value[1]));
  free(s);
}

/* Two starts 0.2 apart and one across the seam. */
TEST(test_intermingledness) {
  const int16_t id[] = {0, 0, 1, -1};
  const double start[] = {3, 0, 3, 0.2, -3, 0, 1, 1};
  scene *s = measures_make(2, 1, NULL);
  double with[MOST], value[MOST];
  s->measured.starts = (kz_ended){.n = 4, .start = start, .id = id};
  kz_measure_intermingled_with(&s->measured, with);
  kz_measure_intermingledness(&s->measured, value);
  const double across = 2 * M_PI - 6, between = (across + hypot(across, 0.2)) / 2;
  assert_true(fabs(with[1] - 0.1 / between) < 1e-14 && with[0] == 1 && with[2] == 0);
  assert_true(value[0] == with[1] && value[1] == 0);
  free(s);
}

/* A shear: its powers grow before they fall. And the norm: with scale 20 the shear is weaker. */
TEST(test_growth_near_a_cycle) {
  kz_tangent tangent[] = {{{0.8, 10, 0, 0.8}}, {{0.5, 0, 0, 0.25}}};
  scene *s = measures_make(2, 1, NULL);
  double value[MOST], expected = 1;
  s->measured.tangent = tangent;
  s->entry[0].row.multiplier_re[0] = exp(-0.5);
  s->entry[1].row.period = 0;
  kz_measure_return_time(&s->measured, value);
  assert_true(fabs(value[0] - 2) < 1e-14 && isnan(value[1]));
  s->entry[1].row.period = 1;
  kz_measure_reactivity(&s->measured, value);
  assert_true(fabs(value[0] - (10 + sqrt(100 + 4 * 0.64)) / 2) < 1e-12 && fabs(value[1] - 0.5) < 1e-15);
  for (int k = 1; k < 200; k++) { /* the power k of the matrix is (p, k q; 0, p) */
    const double p = pow(0.8, k), q = 10 * k * pow(0.8, k - 1);
    expected = fmax(expected, (q + sqrt(q * q + 4 * p * p)) / 2);
  }
  kz_measure_amplification(&s->measured, value);
  assert_true(fabs(value[0] / expected - 1) < 1e-12 && value[1] == 1);
  s->plan.options.shock_scale = 0.1;
  kz_measure_reactivity(&s->measured, value);
  assert_true(fabs(value[0] - (1 + sqrt(1 + 4 * 0.64)) / 2) < 1e-12);
  free(s);
}

TEST(test_smallest_shocks) {
  const int32_t id_of[] = {-1, 1, 0};
  kz_resilience point[] = {
      {.number = 2, .shock = {{.size = NAN}, {.size = 3}, {.size = 2}}, .harmless = {{1, 4, 0}, {2, 4, 0}}},
      {.number = 1, .shock = {{.size = 5}, {.size = 4}, {.size = 1}}, .harmless = {{4, 4, 0}, {0, 4, 0}}},
      {.number = 1, .shock = {{.size = 0.5}, {.size = 9}, {.size = NAN}}, .harmless = {{2, 4, 0}, {2, 4, 0}}}};
  scene *s = measures_make(2, 1, NULL);
  double value[MOST];
  s->measured.catalogue.id_of = (int32_t *)id_of;
  s->measured.n_points = 3;
  s->measured.point = point;
  s->entry[1].row.period = 2;
  s->plan.options.sizes = (kz_reals){2, {0.1, 0.3}};
  kz_measure_shock_angle(&s->measured, value);
  assert_true(isnan(value[0]) && value[1] == 0.5);
  kz_measure_shock_velocity(&s->measured, value);
  assert_true(value[0] == 3 && value[1] == 4);
  kz_measure_shock(&s->measured, value);
  assert_true(value[0] == 2 && value[1] == 1);
  kz_measure_harmless(&s->measured, value);
  assert_true(value[0] == 0.25 && value[1] == 0.5 && value[2] == 0.75 && value[3] == 0.25);
  free(s);
}
