#include "step_error.h"

#include <float.h>
#include <math.h>

#include "kapitza/dynamics.h"

/* rad: above it the error of a period in double precision is that of the steps, not of rounding. */
static const double ROUNDED = 1e-10;

/* The error of a class in quad precision, measured in double with so few steps that rounding does not show, and scaled by the
 * scheme's order: with fewer steps the error falls faster than that, if at all. */
static double quad_error(const kz_pendulum *pendulum, const kz_numerics *numerics, const double *speed) {
  kz_numerics fewer = *numerics;
  kz_scheme scheme;
  double error;
  kz_scheme_row(numerics->scheme, &scheme);
  for (;; fewer.steps_per_period /= 2) {
    kz_step_errors(pendulum, &fewer, 1, speed, &error);
    if (error > ROUNDED || fewer.steps_per_period == 1) break;
  }
  return error < DBL_MAX ? error * pow((double)fewer.steps_per_period / numerics->steps_per_period, scheme.order) : error;
}

static void find_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int first, int n, kz_speed_errors *classes) {
  if (numerics->precision == KZ_QUAD)
    for (int c = first; c < first + n; c++) classes->error[c] = quad_error(pendulum, numerics, classes->speed + c);
  else
    kz_step_errors(pendulum, numerics, n, classes->speed + first, classes->error + first);
}

kz_speed_errors kz_step_error_classes(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  kz_speed_errors classes = {{0}, {0}};
  double top = fmax(fmax(fastest, 1.5), 2 * sqrt(fabs(pendulum->k) + fabs(pendulum->m)));
  for (int c = 1; c <= KZ_SPEED_CLASSES; c++) classes.speed[c] = ldexp(top, c - KZ_SPEED_CLASSES);
  find_errors(pendulum, numerics, 0, KZ_SPEED_CLASSES, &classes);
  return classes;
}

int kz_worst_class(const kz_speed_errors *classes) {
  int worst = 0;
  for (int c = 1; c < KZ_SPEED_CLASSES; c++)
    if (classes->error[c] > classes->error[worst]) worst = c;
  return worst;
}

double kz_worst_error(const kz_speed_errors *classes) {
  return classes->error[kz_worst_class(classes)];
}

bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most, kz_numerics *numerics) {
  kz_speed_errors classes = kz_step_error_classes(pendulum, numerics, fastest);
  for (int worst; worst = kz_worst_class(&classes), classes.error[worst] > tolerance;) {
    do { /* only the worst class, so that a hopeless case is refused quickly */
      const double before = classes.error[worst];
      if (numerics->steps_per_period > most / 2) return false;
      numerics->steps_per_period *= 2;
      find_errors(pendulum, numerics, worst, 1, &classes);
      if (before < ROUNDED && classes.error[worst] > before / 2) return false; /* only rounding is left */
    } while (classes.error[worst] > tolerance);
    classes = kz_step_error_classes(pendulum, numerics, fastest);
  }
  return true;
}

bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  const kz_speed_errors classes = kz_step_error_classes(pendulum, numerics, fastest);
  return kz_worst_error(&classes) <= KZ_STEPS_LOST;
}
