#include "step_error.h"

#include <math.h>

#include "kapitza/dynamics.h"

/* rad: above it the error of a period in double precision is that of the steps, not of rounding. */
static const double ROUNDED = 1e-10;

kz_speed_errors kz_step_error_classes(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  kz_speed_errors classes = {{0}, {0}};
  double top = fmax(fmax(fastest, 1.5), 2 * sqrt(kz_stiffness(pendulum)));
  for (int c = 1; c <= KZ_SPEED_CLASSES; c++) classes.speed[c] = ldexp(top, c - KZ_SPEED_CLASSES);
  kz_step_errors(pendulum, numerics, KZ_SPEED_CLASSES, classes.speed, classes.error);
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
      kz_step_errors(pendulum, numerics, 1, classes.speed + worst, classes.error + worst);
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
