/* The linear and the slow model against what is known in closed form. */
#include "../../tools/test.h"

#include <math.h>

#include "kapitza/kernel.h"

enum { SAMPLES = 100, PERIODS = 50, ALL = SAMPLES * PERIODS + 1 };
static const double PI = 3.14159265358979323846;
static double theta[ALL], velocity[ALL];

/* m = 0: a damped oscillator. */
TEST(linear_without_drive) {
  const kz_pendulum pendulum = {0.09, 0.02, 0};
  const double omega = sqrt(0.09 - 0.0001), phase = atan2(0.01, omega);
  kz_sample_model(KZ_MATHIEU, &pendulum, PERIODS, SAMPLES, (double[]){0.5, 0}, theta, velocity);
  for (int i = 0; i < ALL; i++) {
    double t = 2 * PI * i / SAMPLES;
    assert_true(fabs(theta[i] - 0.5 / cos(phase) * exp(-0.01 * t) * cos(omega * t - phase)) < 1e-12);
  }
}

/* On transition curve 2 at k = 0 the sine solution has twice the period of the drive (BUT Eq. 4). */
TEST(curve_2_is_flutter) {
  const kz_pendulum pendulum = {0, 0, 0.4540231668672888};
  kz_sample_model(KZ_MATHIEU, &pendulum, PERIODS, SAMPLES, (double[]){0, 0.1}, theta, velocity);
  for (int i = 0; i + 2 * SAMPLES < ALL; i++) assert_true(fabs(theta[i] - theta[i + 2 * SAMPLES]) < 1e-12);
  assert_true(fabs(velocity[SAMPLES] + 0.1) < 1e-13);
}

/* The energy of the slow motion by the closed form of the potential of BSG Eq. (10). */
static double models_energy(const kz_pendulum *p, double angle, double v) {
  double u = 1 - p->k * cos(angle), first = 1 - p->k;
  double g = 0.5 * log((u * u + p->beta * p->beta) / (first * first + p->beta * p->beta)) - (u - first);
  if (p->beta > 0) g += p->beta * (atan(u / p->beta) - atan(first / p->beta));
  return 0.5 * v * v + p->k * (1 - cos(angle)) + 0.5 * p->m * p->m / (p->k * p->k) * g;
}

TEST(slow_motion_keeps_its_energy) {
  const kz_pendulum pendulum = {1.0 / 9, 0, 0.6};
  kz_sample_model(KZ_EFFECTIVE, &pendulum, PERIODS, SAMPLES, (double[]){2.0, 0.3}, theta, velocity);
  const double start = models_energy(&pendulum, 2.0, 0.3);
  for (int i = 0; i < ALL; i++) assert_true(fabs(models_energy(&pendulum, theta[i], velocity[i]) - start) < 1e-12);
}

/* Damping takes the power beta v^2, whatever the potential. */
TEST(slow_motion_loses_what_damping_takes) {
  const kz_pendulum pendulum = {1.0 / 9, 0.05, 0.6};
  kz_sample_model(KZ_EFFECTIVE, &pendulum, PERIODS, SAMPLES, (double[]){2.5, 0}, theta, velocity);
  double taken = 0, h = 2 * PI / SAMPLES;
  for (int i = 0; i + 2 < ALL; i += 2)
    taken += pendulum.beta * h / 3 *
             (velocity[i] * velocity[i] + 4 * velocity[i + 1] * velocity[i + 1] + velocity[i + 2] * velocity[i + 2]);
  double lost = models_energy(&pendulum, 2.5, 0) - models_energy(&pendulum, theta[ALL - 1], velocity[ALL - 1]);
  assert_true(fabs(lost - taken) < 1e-7);
}
