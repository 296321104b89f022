/* reference: whole drive periods in quad precision (Fortran; layer 0). States in real128, moved by Taylor series of order 56
 * whose steps follow the motion; independent of the schemes of kernel.h. Labels are compared with it: its error is some 1e-32 a
 * period, that of double precision 1e-16. */
#ifndef KAPITZA_REFERENCE_H
#define KAPITZA_REFERENCE_H

#include <stdint.h>

#include "kapitza/kernel.h"

/* Steps a period that cost least; any other number gives the same motion to some 1e-32 a period. */
enum { KZ_REFERENCE_STEPS = 18 };

/* A state in quad precision. Opaque: kz_reference_start fills it, kz_reference_read shows it. Owned by the caller. */
typedef struct {
  _Alignas(16) unsigned char quads[32];
  int64_t turns;
} kz_reference_state;

/* States [n] at t = 0 from doubles: theta [n] in rad, velocity [n] in rad per drive radian, both taken as exact. */
void kz_reference_start(int64_t n, const double *theta, const double *velocity, kz_reference_state *states);

/* Advances states [n] through `periods` whole periods with `steps` >= 1 a period, halved for a state whose series does not
 * converge on them. A motion that no halving carries (some 1e7 times faster than the drive) becomes NaN. A state's result
 * depends neither on its neighbours nor on how periods are shared out to calls; eight states or more go together at best
 * speed, and tables are made per call. */
void kz_reference_advance(const kz_pendulum *pendulum, int32_t steps, int64_t n, int64_t periods, kz_reference_state *states);

/* The states rounded to doubles: theta [n] wrapped to [-pi, pi], turns [n] = net turns since kz_reference_start. */
void kz_reference_read(int64_t n, const kz_reference_state *states, double *theta, double *velocity, int64_t *turns);

#endif
