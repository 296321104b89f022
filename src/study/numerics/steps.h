/* Error of a drive period by classes of speeds, and the steps that keep it small enough. Not collective. */
#pragma once

#include "kapitza/kernel.h"

/* Classes of speeds: the fastest half is the last class, the faster half of the rest the one before, and so on. */
enum { KZ_SPEED_CLASSES = 8 };

typedef struct {
  double speed[KZ_SPEED_CLASSES + 1]; /* rad per drive radian, from 0 */
  double error[KZ_SPEED_CLASSES];     /* rad, of one drive period, an upper estimate; DBL_MAX = diverges */
} kz_speed_errors;

/* Errors by step doubling, on a sample of states with speeds up to `fastest` (rad per drive radian), or up to those of
 * rotations and falls if these are larger. */
kz_speed_errors kz_step_error_classes(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* The class of the largest error, and that error, rad. */
int kz_worst_class(const kz_speed_errors *classes);
double kz_worst_error(const kz_speed_errors *classes);

/* Steps that resolve this pendulum's fastest oscillation as `gentle` steps do for a weak drive. */
double kz_steps_by_stiffness(const kz_pendulum *pendulum, double gentle);

/* Raises numerics->steps_per_period until the error of every class is at most `tolerance` (rad). False if this does not
 * help or needs more than `most` steps; the steps are then the last number tried. */
bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most,
                     kz_numerics *numerics);

/* False where the error of one drive period exceeds KZ_STEPS_REFUSED or the motion diverges: labels would be random. */
#define KZ_STEPS_REFUSED 0.1 /* rad */
bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* The steps of a scheme whose error at speeds from 0 to `fastest` (rad per drive radian) is at most `tolerance` (rad):
 * measured with the steps of *numerics, and scaled by the order of the scheme. Within least .. most. */
int32_t kz_steps_scaled(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest, double tolerance,
                        int32_t least, int32_t most);

/* split6 with its default number of steps. */
kz_numerics kz_steps_plain(void);
