/* steps: whether the numerics can carry a scene, asked before anything is labelled (C; floor 3, study). Not collective. */
#ifndef KAPITZA_STEPS_H
#define KAPITZA_STEPS_H

#include "kapitza/study.h"

/* Classes of speeds: the fastest half of all speeds, half of those, and so on; class 0 is what is left. */
enum { KZ_SPEED_CLASSES = 8 };

typedef struct {
  double speed[KZ_SPEED_CLASSES + 1]; /* rad per drive radian, from 0 */
  double error[KZ_SPEED_CLASSES];     /* rad, of one drive period; DBL_MAX = diverges */
} kz_step_trial;

/* Step doubling on a sample of the speeds up to `fastest`, and those that rotation and fall bring. */
kz_step_trial kz_steps_try(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);
/* The largest error of all classes. */
double kz_steps_worst(const kz_step_trial *trial);

/* KZ_REFUSED where one drive period of the scene's basin or attractors is off by a tenth of a radian or diverges: the message says
 * at which speeds, and how many steps would do. */
kz_status kz_steps_check(const kz_scene *scene);

/* A line for each class that is off by more than 1e-4 rad, and one where the damping is too weak to settle anything within
 * max_periods. Returns the largest error. */
double kz_steps_warn(const kz_scene *scene, double fastest, int64_t max_periods, FILE *summary);

/* A line where one period of the map table is off by more than 1e-4 rad. */
void kz_steps_warn_table(double defect, FILE *summary);

#endif
