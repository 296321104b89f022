/* Errors of one drive period by classes of speeds. */
#ifndef KAPITZA_STUDY_STEP_ERROR_H
#define KAPITZA_STUDY_STEP_ERROR_H

#include "kapitza/kernel.h"

/* Classes of speeds: the fastest half of all speeds is the last class, the faster half of the rest the class before, and so on. */
enum { KZ_SPEED_CLASSES = 8 };

typedef struct {
  double speed[KZ_SPEED_CLASSES + 1]; /* rad per drive radian, from 0 */
  double error[KZ_SPEED_CLASSES];     /* rad, of one drive period, an upper estimate; DBL_MAX = diverges */
} kz_speed_errors;

/* Errors by step doubling, on a sample of states with speeds up to `fastest` (rad per drive radian), or up to those of rotations and falls
 * if these are larger. */
kz_speed_errors kz_step_error_classes(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* The class of the largest error, and that error, rad. */
int kz_worst_class(const kz_speed_errors *classes);
double kz_worst_error(const kz_speed_errors *classes);

#endif
