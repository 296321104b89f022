#include "step_error.h"

#include <math.h>

#include "kapitza/dynamics.h"

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
