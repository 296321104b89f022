/* Charts and curves at m = 1e-12 .. 1e3, k = -1e4 .. 1e4, Q = 0.5 .. 1e8: right, never an unexplained NaN. */
#include <math.h>
#include <string.h>

#include "../tools/test.h"

#include "kapitza/analysis.h"
#include "kapitza/kernel.h"
#include "curves.h"

#define PI 3.14159265358979323846

static double stability_value(const char *name, double k, double beta, double quality_factor) {
  kz_damping damping = {beta, quality_factor};
  for (int i = 0; i < kz_curve_count; i++) {
    double m;
    if (strcmp(kz_curves[i].name, name) != 0) continue;
    kz_curve_values(&kz_curves[i], &damping, 1, &k, &m);
    return m;
  }
  fail_msg("no curve %s", name);
  return NAN;
}

TEST(chart_holds_numbers) {
  const double ks[] = {-1e4, -300, -1, -1e-8, 0, 1e-300, 1e-8, 0.25, 1, 77, 1e4};
  const double ms[] = {0, 1e-300, 1e-12, 1e-3, 1, 30, 1e3, -1e3}, qs[] = {0.5, 1, 10, 1e8, INFINITY};
  for (int i = 0; i < 11; i++)
    for (int j = 0; j < 8; j++)
      for (int l = 0; l < 5; l++) {
        double beta = sqrt(fabs(ks[i])) / qs[l], log_multiplier, angle;
        uint8_t stable;
        kz_linear_floquet(NULL, 1, &ks[i], &beta, &ms[j], &log_multiplier, &angle, &stable);
        assert_true(isfinite(log_multiplier) && angle >= 0 && angle <= 0.5 && stable <= 1);
        assert_true(log_multiplier >= -PI * beta);
        if (beta > 0) assert_int_equal(stable, log_multiplier < 0);
      }
}

/* On the axis the tongues begin at k = n^2/4: there |trace| is 2, neither below nor above. */
TEST(feet_of_the_tongues_are_on_the_edge) {
  const double m = 0, beta = 0;
  for (int n = 0; n <= 40; n++) {
    double k = 0.25 * n * n, log_multiplier, angle;
    uint8_t stable;
    kz_linear_floquet(NULL, 1, &k, &beta, &m, &log_multiplier, &angle, &stable);
    assert_true(log_multiplier == 0 && stable == 0 && angle == (n % 2 ? 0.5 : 0));
    k += 1e-9 * (1 + k);
    kz_linear_floquet(NULL, 1, &k, &beta, &m, &log_multiplier, &angle, &stable);
    assert_true(log_multiplier == 0 && stable == 1);
  }
}

/* Multipliers beyond any double: the growth of u'' = 1e4 u is exp(100 t). */
TEST(growth_is_a_logarithm) {
  const double k = -1e4, m = 0, betas[] = {0, 1, 200, 1e4};
  for (int i = 0; i < 4; i++) {
    double log_multiplier, angle, beta = betas[i];
    uint8_t stable;
    kz_linear_floquet(NULL, 1, &k, &beta, &m, &log_multiplier, &angle, &stable);
    double exact = 2 * PI * 2 * 1e4 / (beta + sqrt(beta * beta + 4e4));
    assert_true(fabs(log_multiplier - exact) < 1e-13 * (2 * PI * sqrt(1e4 + beta * beta / 4)) + 1e-12 * exact);
  }
}

/* 40-digit Taylor integration: angles deep in stable zones. */
TEST(angles_to_twelve_digits) {
  const struct {
    double k, beta, m, angle;
  } points[] = {
      {0.3, 0, 0.1, 0.48916426676292704},
      {1.3, 0, 0.7, 0.10659442367131325},
      {2, 0, 1.5, 0.34987408247573676},
      {-0.008264462809917356, 0.01818181818181818, 0.3, 0.20674537671485816},
      {100.3, 0, 10, 0.0087365084624156612},
      {10000.0, 0, 1000.0, 0.062648708655636149},
      {9999.3, 1e-06, 1000.0, 0.066155369404008519},
      {1e-08, 0, 0.0002, 0.00017320508667472875},
      {-5e-17, 0, 1e-07, 7.0356236397351988e-8},
      {9992.7, 0, 1e-12, 0.036506663682462484},
      {60, 0, 55, 0.18016346990085501},
  };
  for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
    double log_multiplier, angle;
    uint8_t stable;
    kz_linear_floquet(NULL, 1, &points[i].k, &points[i].beta, &points[i].m, &log_multiplier, &angle, &stable);
    assert_true(fabs(angle - points[i].angle) < 1e-12 * angle + 1e-16);
    assert_true(stable == 1 && log_multiplier == -PI * points[i].beta);
  }
}

/* Next to the axis m follows from the distance to it: k = 1/4 -+ m/2, 1 - m^2/12, 1 + 5 m^2/12, -m^2/2. */
TEST(curves_next_to_the_axis) {
  for (double distance = 1e-3; distance > 1e-15; distance *= 0.1) {
    double below = 0.25 - distance, above = 0.25 + distance, tolerance = distance + 1e-12;
    assert_true(fabs(stability_value("exact_2", below, 0, NAN) / (2 * (0.25 - below)) - 1) < tolerance);
    assert_true(fabs(stability_value("exact_3", above, 0, NAN) / (2 * (above - 0.25)) - 1) < tolerance);
    below = 1 - distance, above = 1 + distance;
    assert_true(fabs(stability_value("exact_4", below, 0, NAN) / sqrt(12 * (1 - below)) - 1) < tolerance);
    assert_true(fabs(stability_value("exact_5", above, 0, NAN) / sqrt(12 * (above - 1) / 5) - 1) < 2 * tolerance);
    assert_true(fabs(stability_value("exact_1", -distance, 0, NAN) / sqrt(2 * distance) - 1) < tolerance);
  }
}

/* Far below, a_r and b_(r+1) follow 4k = -2q + 2 (2r+1) sqrt(q) - ((2r+1)^2 + 1)/8 - ... (DLMF 28.8.1). */
TEST(curves_far_below) {
  const char *names[] = {"exact_1", "exact_2", "exact_3_upper", "exact_4", "exact_5_upper"};
  const int order[] = {0, 0, 1, 1, 2};
  for (int i = 0; i < 5; i++)
    for (double k = -1e3; k >= -1e6; k *= 10) {
      double q = 2 * stability_value(names[i], k, 0, NAN), s = 2 * order[i] + 1, h = sqrt(q);
      double a = -2 * q + 2 * s * h - (s * s + 1) / 8 - (s * s * s + 3 * s) / (128 * h) -
                 (5 * pow(s, 4) + 34 * s * s + 9) / (4096 * q);
      assert_true(fabs(a / (4 * k) - 1) < 100 * pow(q, -2));
    }
}

/* The damped edges exist and order themselves for every quality factor; thresholds keep their digits at Q = 1e8. */
TEST(damping_at_its_ends) {
  for (double q = 0.5; q <= 1e8; q *= 16)
    for (double k = -1e-12; k >= -1e4; k *= 100) {
      double lower = stability_value("damped_0", k, 0, q), first = stability_value("damped_1", k, 0, q),
             second = stability_value("damped_2", k, 0, q);
      assert_true(lower > 0 && first >= lower && second > first);
      assert_true(lower >= stability_value("exact_1", k, 0, q) * (1 - 1e-13));
    }
  kz_threshold threshold;
  kz_tongue_threshold(1, 1e8, KZ_BY_FLOQUET, &threshold);
  assert_true(fabs(threshold.m_lowest / 5e-9 - 1) < 1e-14);
  kz_tongue_threshold(2, 1e8, KZ_BY_FLOQUET, &threshold);
  assert_true(fabs(threshold.m_lowest / 2e-4 - 1) < 1e-8);
}

/* The slow energy keeps its digits where k^2 would cancel them, and where u passes 0. */
TEST(potential_at_its_ends) {
  for (double k = 1e-3; k > 1e-300; k *= 1e-3) {
    kz_energy energy;
    kz_potential_energy(k, 0, 1, 2, &energy);
    assert_true(fabs(energy.exact / energy.simple - 1) < 3 * k + 1e-14);
  }
  for (double k = -1e4; k <= 1e4; k += 333) {
    kz_energy energy;
    kz_potential_energy(k, 0.1, 1e3, 3, &energy);
    assert_true(isfinite(energy.exact) && isfinite(energy.blackburn) && isfinite(energy.simple));
  }
}
