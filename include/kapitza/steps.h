/* steps: whether the numerics can carry a scene, asked before anything is labelled (C; floor 3, study). Not collective. */
#ifndef KAPITZA_STEPS_H
#define KAPITZA_STEPS_H

#include "kapitza/study.h"

/* Doubles the steps until every class is right to `tolerance` (rad); false where that does not help, or takes more than
 * `most` steps: then the last number tried. */
bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most, kz_numerics *numerics);

/* False where one drive period is off by a tenth of a radian or diverges: labels would be chance. */
bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* KZ_REFUSED where the steps do not carry a study's motions. The message begins with the keys that a user could change
 * ("numerics.steps_per_period|basin.velocity: ..."), and says at which speeds, and how many steps would do. A sweep is tried at
 * both ends and between. */
kz_status kz_steps_check(const kz_scene *scene);

/* A line for each class of speeds up to `fastest` that is off by more than 1e-4 rad. Returns the largest error. */
double kz_steps_warn(const kz_scene *scene, double fastest, FILE *summary);
/* The same for the worst of a sweep's values. */
void kz_steps_warn_sweep(const kz_scene *scene, FILE *summary);

/* A line where one period of the map table is off by more than 1e-4 rad. */
void kz_steps_warn_table(double defect, FILE *summary);

#endif
