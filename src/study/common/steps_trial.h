/* A trial of the steps: the error of one drive period for each class of speeds. */
#ifndef KAPITZA_STUDY_STEPS_TRIAL_H
#define KAPITZA_STUDY_STEPS_TRIAL_H

#include "kapitza/kernel.h"

/* Classes of speeds: the fastest half of all speeds, half of those, and so on; class 0 is what is left. */
enum { KZ_SPEED_CLASSES = 8 };

typedef struct {
  double speed[KZ_SPEED_CLASSES + 1]; /* rad per drive radian, from 0 */
  double error[KZ_SPEED_CLASSES];     /* rad, of one drive period, an upper estimate; DBL_MAX = diverges */
} kz_step_trial;

/* Step doubling on a sample of the speeds up to `fastest` (rad per drive radian), and those that rotation and fall bring. */
kz_step_trial kz_try_steps(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* The class of the largest error, and that error, rad. */
int kz_worst_class(const kz_step_trial *classes);
double kz_worst_error(const kz_step_trial *classes);

#endif
