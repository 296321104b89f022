/* Release of motions at another phase of the drive, or on a ramp of it (Fortran, above common). */
#pragma once

#include <stdint.h>

/* Beginning of a motion. It is released at t = phase less the whole turns of the phase. From t = 0 to t = 2 pi periods,
 * damping and drive change from the values here to those of the pendulum. */
typedef struct {
  double phase;   /* Phase of the drive, rad; below 0 = before a strobe */
  double periods; /* Length of the ramp, drive periods; 0 = none */
  double damping; /* beta at t = 0 */
  double drive;   /* Strength of the whole drive at t = 0, relative to that after the ramp */
  int32_t smooth; /* 0: linear in time; 1: 3 s^2 - 2 s^3, which begins and ends without a kink */
} kz_release;

/* Number of the first strobe (1: t = 2 pi) of the final drive; 0 if the release is on it. */
int64_t kz_release_strobes(const kz_release *release);
