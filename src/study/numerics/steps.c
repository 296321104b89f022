#include "steps.h"

#include "kapitza/dynamics_steps.h"

static const double ROUNDING = 1e-13; /* rad: an error of a period below this is hardly more than rounding */

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

/* The numerics whose steps are searched. */
typedef struct {
  const kz_pendulum *pendulum;
  double fastest;
  kz_numerics *numerics;
} trial;

double kz_steps_by_stiffness(const kz_pendulum *pendulum, double gentle) {
  return gentle * ceil(sqrt(fmax(1, kz_stiffness(pendulum))));
}

static double error_of(int32_t steps, void *context) {
  const trial *t = context;
  t->numerics->steps_per_period = steps;
  const kz_speed_errors classes = kz_step_error_classes(t->pendulum, t->numerics, t->fastest);
  return kz_worst_error(&classes);
}

bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most,
                     kz_numerics *numerics) {
  trial t = {pendulum, fastest, numerics};
  int32_t tried;
  return kz_steps_search(error_of, &t, kz_scheme_at(numerics->scheme).order, tolerance, numerics->steps_per_period,
                         most, &tried) <= tolerance;
}

bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest) {
  const kz_speed_errors classes = kz_step_error_classes(pendulum, numerics, fastest);
  return kz_worst_error(&classes) <= KZ_STEPS_REFUSED;
}

int32_t kz_steps_scaled(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest, double tolerance,
                        int32_t least, int32_t most) {
  const double speed[] = {0, fastest};
  double error;
  kz_step_errors(pendulum, numerics, 1, speed, &error);
  const double steps = ceil(kz_expected_steps(numerics->steps_per_period, fmax(error, ROUNDING), tolerance,
                                              kz_scheme_at(numerics->scheme).order));
  return (int32_t)fmin(fmax(steps, least), most);
}

kz_numerics kz_steps_plain(void) {
  const int32_t split6 = kz_scheme_find("split6");
  return (kz_numerics){.scheme = split6, .steps_per_period = kz_scheme_at(split6).default_steps};
}
