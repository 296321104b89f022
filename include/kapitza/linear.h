/* linear: the pendulum near an equilibrium, a lane per parameter point (Fortran; layer 0, part of the kernel).
 *
 * u'' + beta u' + (k - m cos t) u = 0   (BUT Eq. 23; beta = 0: Mathieu's equation with a = 4k, q = 2m)
 * t in drive radians; about the inverted state k is negative. With u = exp(-beta t/2) w the damping leaves the equation,
 * w'' + (k - beta^2/4 - m cos t) w = 0, which is even in t: half a period is enough.
 *
 * Half a period: w(pi) = c, s and w'(pi) = c', s' of the two solutions with (w, w') = (1, 0), (0, 1) at t = 0. Over a whole
 * period trace/2 = 2 c s' - 1 = 2 s c' + 1, so every transition curve is a zero of one of the four numbers. */
#ifndef KAPITZA_LINEAR_H
#define KAPITZA_LINEAR_H

#include <stdint.h>

/* One point, of Hill's equation without damping: matrix = c, s, c', s' in units of 2^exponent. */
typedef struct {
  double c, s, c_dot, s_dot;
  int64_t exponent; /* 0 unless a number exceeded 2^400 */
} kz_half_period;

/* Solutions at t = pi for n points k [n], beta [n], m [n]. Relative error about 1e-15 (1 + sqrt(|k| + |m|)). */
void kz_linear_half_period(int64_t n, const double *k, const double *beta, const double *m, kz_half_period *half);

/* Floquet's answer for n points.
 * log_multiplier [n]: natural log of the largest |multiplier| over one period.
 * angle [n]: argument of that multiplier / 2 pi, in [0, 1/2].
 * stable [n]: 1 where |trace| < 2 (beta = 0), |trace| < 1 + det (beta > 0), else 0. */
void kz_linear_floquet(int64_t n, const double *k, const double *beta, const double *m, double *log_multiplier, double *angle,
                       uint8_t *stable);

#endif
