/* model: how motions begin that are released at another phase of the drive, or on a ramp of it (Fortran; the layer above common). */
#pragma once

#include <stdint.h>

/* How a motion begins. It is released at t = phase less the whole turns of the phase. From t = 0 to t = 2 pi periods, damping and drive change from the values here to those
 * of the pendulum. */
typedef struct {
  double phase;   /* rad, any; below 0 = before a strobe */
  double periods; /* of the ramp, drive periods; 0 = none */
  double damping; /* beta at t = 0 */
  double drive;   /* strength of the whole drive at t = 0; 1 = that after the ramp */
  int32_t smooth; /* 0: linear in time; 1: 3 s^2 - 2 s^3, which begins and ends without a kink */
} kz_release;

/* Number of the first strobe (t = 2 pi is number 1) from which on the drive has its final form; 0 if it has this form from the release. */
int64_t kz_release_strobes(const kz_release *release);
