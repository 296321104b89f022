/* Whole drive periods in quad precision (real128), by Taylor series of order 56 whose steps adapt to the motion. The
 * method shares nothing with the schemes of the kernel. Its error is some 1e-33 a period, and up to 1e-30 for a strong
 * drive; that of double precision is 1e-16. */
#pragma once

#include "kapitza/kernel.h"

/* A state in quad precision. Opaque: kz_reference_start fills it, kz_reference_read reads it. The caller owns it. */
typedef struct {
  _Alignas(16) unsigned char quads[32];
  int64_t turns;
} kz_reference_state;

/* Sets states [n] at t = 0 to theta [n] + low [n][0] (rad) and velocity [n] + low [n][1] (rad per drive radian). low
 * holds digits below the last places of the doubles; NULL = zeros. The sums count as exact. */
void kz_reference_start(int64_t n, const double *theta, const double *velocity, const double *low,
                        kz_reference_state *states);

/* Advances states [n] through `periods` whole periods with `steps` >= 1 a period. Steps are halved for a state whose
 * series does not converge; a motion for which no halving helps (some 1e7 times faster than the drive) becomes NaN. The
 * result of a state depends neither on the other states nor on how the periods are divided between calls. Eight or more
 * states at once are fastest; each call makes its tables anew. */
void kz_reference_advance(const kz_pendulum *pendulum, int32_t steps, int64_t n, int64_t periods,
                          kz_reference_state *states);

/* The states rounded to doubles: theta [n] wrapped to [-pi, pi], turns [n] = net turns since kz_reference_start. */
void kz_reference_read(int64_t n, const kz_reference_state *states, double *theta, double *velocity, int64_t *turns);

/* An upper estimate of the error of a period with KZ_REFERENCE_STEPS, relative to hypot(pi, velocity), for speeds up to
 * `fastest` (rad per drive radian): the measured difference of two numbers of steps, with a margin. */
double kz_reference_error(const kz_pendulum *pendulum, double fastest);
