/* Transition curves of any wave form: Hill's determinant, Floquet, Mathieu and the square wave's closed form agree. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define OWN_MAIN
#include "../tools/test.h"

#include "curves.h"
#include "kapitza/analysis.h"
#include "kapitza/kernel.h"

#define PI 3.14159265358979323846
enum { FORMS = 100 };

static double random_between(double low, double high) {
  return low + (high - low) * drand48();
}

/* A random drive of a few harmonics, even in time or not. */
static kz_pendulum random_form(bool even) {
  kz_pendulum form = {.m = 1, .harmonics = 1 + (int32_t)random_between(0, 8)};
  for (int j = 0; j < form.harmonics; j++) {
    form.vertical[j][0] = random_between(-1, 1) / (j + 1);
    form.vertical[j][1] = even ? 0 : random_between(-1, 1) / (j + 1);
  }
  return form;
}

/* Whether the largest multiplier at (k, m) is real with the curve's sign: +1 for curves 1, 4, 5. */
static bool is_in_tongue(const kz_pendulum *form, int curve, double k, double m) {
  double log_multiplier, angle, none = 0;
  uint8_t stable;
  kz_linear_floquet(form, 1, &k, &none, &m, &log_multiplier, &angle, &stable);
  return log_multiplier > 0 && angle == (curve == 2 || curve == 3 ? 0.5 : 0);
}

/* Edges by Hill's determinant are where Floquet's multiplier, integrated, leaves the circle: to 1e-11, in order. */
TEST(edges_of_any_wave_are_floquets) {
  int seen = 0;
  for (int i = 0; i < FORMS; i++) {
    const kz_pendulum form = random_form(i % 2 == 0);
    const double m = random_between(-3, 3);
    double k[6];
    for (int curve = 1; curve <= 5; curve++) k[curve] = kz_hill_edge(&form, curve, m);
    for (int curve = 1; curve <= 5; curve++) {
      const double step = 1e-11 * (1 + fabs(m) * kz_stiffness(&form)), into = curve == 2 || curve == 4 ? step : -step;
      const int other = curve % 2 == 0 ? curve + 1 : curve - 1;
      assert_true(curve == 1 || k[curve] >= k[curve - 1] - step);
      if (other > 1 && fabs(k[curve] - k[other]) < 1e-4) continue; /* the tongue is too thin to stand in */
      assert_true(is_in_tongue(&form, curve, k[curve] + into, m) && !is_in_tongue(&form, curve, k[curve] - into, m));
      seen++;
    }
  }
  assert_true(seen > 4 * FORMS);
}

/* Under the sine they are Mathieu's curves exact_1 to exact_5. */
TEST(edges_of_the_sine_are_mathieus) {
  const kz_pendulum sine = {.m = 1};
  const kz_damping none = {0, NAN};
  int seen = 0;
  for (int row = 0; row < 7; row++)
    for (double k = -600; k < -0.01; k /= 1.7) {
      double m;
      kz_curve_values(&kz_curves[row], &none, 1, &k, &m);
      if (isnan(m)) continue;
      assert_true(fabs(kz_hill_edge(&sine, kz_curves[row].name[6] - '0', m) - k) < 1e-12 * (1 + m));
      seen++;
    }
  assert_true(seen > 50);
}

/* Half of the trace of the square wave's period map less its value on a curve, by cos and cosh in long double. */
static long double square_wave_trace(long double k, long double m) {
  long double c[2], s[2], x[] = {k - m, k + m};
  for (int i = 0; i < 2; i++) {
    const long double root = sqrtl(fabsl(x[i])), turn = root * (long double)PI;
    c[i] = x[i] > 0 ? cosl(turn) : coshl(turn);
    s[i] = root == 0 ? (long double)PI : (x[i] > 0 ? sinl(turn) : sinhl(turn)) / root;
  }
  return c[0] * c[1] - (x[0] + x[1]) / 2 * s[0] * s[1];
}

/* On Meissner's curves the period map, in closed form, has the trace 2 or -2 to 1e-12 of its terms. */
TEST(meissners_edges_are_those_of_the_period_map) {
  for (int curve = 1; curve <= 5; curve++)
    for (double m = 0.003; m < 40; m *= 1.13) {
      const double k = kz_meissner_edge(NULL, curve, m), at = curve == 2 || curve == 3 ? -1 : 1;
      const long double trace = square_wave_trace(k, m), step = 1e-7L * (1 + m),
                        slope = fabsl(square_wave_trace(k + step, m) - square_wave_trace(k - step, m)) / (2 * step);
      assert_true(fabsl(trace - at) < 1e-12L * (1 + m) * (1 + slope));
    }
}

/* Series up to order 7 of the square form are as near to the true one as docs/explanation/stability.md says. */
TEST(series_of_the_square_wave_is_near_meissner) {
  kz_pendulum series = {.m = 1, .harmonics = 7};
  for (int j = 1; j <= 7; j += 2) series.vertical[j - 1][0] = (j % 4 == 1 ? 4 : -4) / (PI * j) - (j == 1);
  const double at[] = {0.5, 1, 2}, most[] = {1.6e-4, 5.4e-4, 2e-3};
  for (int i = 0; i < 3; i++) {
    double farthest = 0;
    for (int curve = 1; curve <= 5; curve++)
      farthest = fmax(farthest, fabs(kz_hill_edge(&series, curve, at[i]) - kz_meissner_edge(NULL, curve, at[i])));
    assert_true(farthest < most[i] && farthest > 0.9 * most[i]);
  }
}

int main(void) {
  srand48(4);
  return run_all_tests(NULL, NULL);
}
