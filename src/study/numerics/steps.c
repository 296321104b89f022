#include "steps.h"

#include <math.h>

#include "kapitza/dynamics.h"

/* rad: above it the error of a period in double precision is that of the steps, not of rounding; below the other hardly any is. */
static const double ROUNDED = 1e-10, ROUNDING = 1e-13;

double kz_steps_by_stiffness(const kz_pendulum *pendulum, double gentle) {
  return gentle * ceil(sqrt(fmax(1, kz_stiffness(pendulum))));
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
  return kz_worst_error(&classes) <= KZ_STEPS_REFUSED;
}

int32_t kz_steps_scaled(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest, double tolerance,
                        int32_t least, int32_t most) {
  const double speed[] = {0, fastest};
  kz_scheme scheme;
  double error;
  kz_scheme_row(numerics->scheme, &scheme);
  kz_step_errors(pendulum, numerics, 1, speed, &error);
  const double steps = ceil(numerics->steps_per_period * pow(fmax(error, ROUNDING) / tolerance, 1.0 / scheme.order));
  return (int32_t)fmin(fmax(steps, least), most);
}

kz_numerics kz_steps_plain(void) {
  const int32_t split6 = kz_scheme_find("split6");
  kz_scheme scheme;
  kz_scheme_row(split6, &scheme);
  return (kz_numerics){.scheme = split6, .steps_per_period = scheme.default_steps};
}
