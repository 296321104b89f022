/* Three ways agree: Floquet multipliers by integration, Hill's determinant, GSL's characteristic values. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define OWN_MAIN
#include "../tools/test.h"

#include "kapitza/analysis.h"
#include "kapitza/kernel.h"

#define PI 3.14159265358979323846
enum { POINTS = 400 };

static double random_between(double low, double high) {
  return low + (high - low) * drand48();
}

static double stability_growth(double k, double beta, double m, double *angle) {
  double log_multiplier;
  uint8_t stable;
  kz_linear_floquet(NULL, 1, &k, &beta, &m, &log_multiplier, angle, &stable);
  return log_multiplier;
}

/* Where a point lies: 0 between the tongues, else the multiplier that grows, +1 or -1. */
static int tongue_sign(double k, double m) {
  double angle;
  const double rate = stability_growth(k, 0, m, &angle);
  return rate > 0 ? (angle == 0 ? 1 : -1) : 0;
}

/* An exact curve is the edge of a tongue to 1e-10 of m, where GSL gives it and beyond. */
TEST(curves_are_floquet_roots) {
  const kz_damping none = {0, NAN};
  int seen = 0;
  for (int row = 0; row < 7; row++)
    for (int i = 0; i < POINTS / 4; i++) {
      double k = i % 5 ? random_between(-5, 2.03) : random_between(-7000, -3000), m;
      kz_curve_values(&kz_curves[row], &none, 1, &k, &m);
      if (isnan(m) || m < 1e-6) continue;
      assert_int_not_equal(tongue_sign(k, m * (1 - 1e-10)), tongue_sign(k, m * (1 + 1e-10)));
      seen++;
    }
  assert_true(seen > 200);
}

/* Damped edges from Hill's determinant: there the largest multiplier by integration crosses the circle, at -1 (tongue
 * 1) or +1 (others). */
TEST(damped_edges_have_multiplier_one) {
  const char *names[] = {"damped_0", "damped_1", "damped_2", "damped_1_upper", "damped_2_upper"};
  for (int row = 0; row < kz_curve_count; row++)
    for (int name = 0; name < 5; name++) {
      if (strcmp(kz_curves[row].name, names[name]) != 0) continue;
      int tongue = name > 2 ? name - 2 : name, seen = 0;
      bool leaves = name == 0 || name > 2; /* growth ends here with rising m */
      for (int i = 0; i < POINTS / 4; i++) {
        double k = random_between(-2, 1.9), m, angle;
        kz_damping damping = {0, exp(random_between(log(0.7), log(1e4)))};
        kz_curve_values(&kz_curves[row], &damping, 1, &k, &m);
        if (isnan(m)) continue;
        double beta = kz_damping_at(&damping, k);
        double below = stability_growth(k, beta, m * (1 - 1e-9), &angle),
               above = stability_growth(k, beta, m * (1 + 1e-9), &angle);
        assert_true(leaves ? below > 0 && above < 0 : below < 0 && above > 0);
        stability_growth(k, beta, m * (leaves ? 1 - 1e-9 : 1 + 1e-9), &angle);
        if (tongue > 0) assert_true(angle == (tongue == 1 ? 0.5 : 0));
        seen++;
      }
      assert_true(seen > 25);
    }
}

/* Both edges of tongue 1 at beta = 0.07, by DOP853 at rtol 1e-12; where the damped tongue ends neither is left. */
TEST(damped_tongue_turns_back) {
  const kz_damping damping = {0.07, NAN};
  const double k[] = {0.3, 0.5, 0.6, 0.63}, edges[2][4] = {{0.125508629944, 0.612655265242, 1.040605809697, NAN},
                                                           {3.012258238175, 2.369918348959, 1.867327450921, NAN}};
  for (int row = 0; row < kz_curve_count; row++)
    for (int upper = 0; upper < 2; upper++) {
      if (strcmp(kz_curves[row].name, upper ? "damped_1_upper" : "damped_1") != 0) continue;
      double m[4];
      kz_curve_values(&kz_curves[row], &damping, 4, k, m);
      for (int i = 0; i < 3; i++) assert_true(fabs(m[i] - edges[upper][i]) < 1e-10);
      assert_true(isnan(m[3]));
    }
}

/* At any n, real subharmonic curves hold solutions with the angle 1/n. */
TEST(subharmonics_have_their_angle) {
  const int32_t orders[] = {3, 5, 8, 17, 100};
  for (int j = 0; j < 5; j++)
    for (int i = 0; i < POINTS / 8; i++) {
      double k = random_between(-1, 1.0 / (orders[j] * orders[j])), exact, formula, angle;
      kz_subharmonic_values(orders[j], 1, &k, &exact, &formula);
      stability_growth(k, 0, exact, &angle);
      assert_true(fabs(angle - 1.0 / orders[j]) < 1e-9);
      assert_true(fabs(formula - exact) < 0.01 * (1 + exact));
    }
}

/* Closed form against quadrature at the crossing, and the energy's slope against BSG (10). */
TEST(potential_is_the_integral_of_the_slow_force) {
  for (int i = 0; i < POINTS; i++) {
    double k = random_between(-0.3, 0.3), beta = random_between(0, 0.2), m = random_between(0, 1);
    double theta = random_between(0.1, 3), h = 1e-3, slope = 0;
    const double weight[] = {1, -8, 8, -1}, at[] = {-2, -1, 1, 2};
    for (int j = 0; j < 4; j++) {
      kz_energy energy;
      kz_potential_energy(k, beta, m, theta + at[j] * h, &energy);
      slope += weight[j] * energy.exact / (12 * h);
    }
    double u = 1 - k * cos(theta);
    double force = k * sin(theta) + 0.5 * m * m * sin(theta) * cos(theta) * u / (u * u + beta * beta);
    assert_true(fabs(slope - force) < 1e-9);
  }
}

/* The rim is the first top of the energy seen from the inverted position, for gravity of any size and sign. */
TEST(rim_is_the_first_top) {
  enum { ANGLES = 4000 };
  int wells = 0;
  for (int i = 0; i < POINTS; i++) {
    double k = random_between(-4, 4), beta = random_between(0.02, 0.5), m = random_between(0, 3 * (1 + fabs(k))),
           top = PI;
    kz_rim rim;
    kz_energy here, next;
    kz_potential_rim(k, beta, m, &rim);
    kz_potential_energy(k, beta, m, PI, &here);
    for (int j = 1; j <= ANGLES; j++, here = next) {
      kz_potential_energy(k, beta, m, PI - PI * j / ANGLES, &next);
      if (next.exact <= here.exact) break;
      top = PI - PI * j / ANGLES;
    }
    if (!rim.stable_inverted) continue;
    assert_true(fabs(rim.exact - top) < 2 * PI / ANGLES);
    wells++;
  }
  assert_true(wells > POINTS / 4);
  kz_rim one, three;
  kz_potential_rim(1.5, 0.1, 3, &one);
  kz_potential_rim(3, 0.3, 6, &three);
  assert_true(fabs(one.exact - 2.304994) < 5e-7 && fabs(three.exact - 1.926) < 5e-4);
}

int main(void) {
  srand48(4);
  return run_all_tests(NULL, NULL);
}
