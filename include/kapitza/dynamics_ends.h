/* dynamics, ends: where motions of many pendulums end, each in a lane of its own (Fortran; layer 1). */
#pragma once

#include "kapitza/model.h"

/* Message for drives other than a vertical sine. */
#define KZ_ENDS_NEED_SINE "sweep.measure ends needs a pivot that moves up and down as a sine; leave one of them out"

/* Where a motion of one of many pendulums ends. */
typedef struct {
  int32_t period;        /* 0 = chaotic: not settled, and neighbours separate; -1 = not settled */
  int32_t winding;       /* net turns per period */
  int32_t centre;        /* 0 down, 1 inverted, 2 rotating, 3 none of these */
  int32_t settling_time; /* drive periods until within 1e-5 rad of the state one period of the cycle before */
  double exponent;       /* largest Lyapunov exponent per drive period: of the cycle, else over 1000 periods */
} kz_plane_ending;

/* Ends of the motions of n pendulums from one start (half-turns, velocity), with `steps` steps of split6 a period. A
 * motion is followed until it returns within 1e-5 rad after up to max_period periods; then Newton's method finds the
 * cycle. Near a cycle that does not attract, the motion is followed on; a start exactly on such a cycle does not
 * settle. max_periods [n]: 0 = do not follow this one. */
void kz_ends_follow(int32_t steps, int64_t n, const kz_pendulum *pendulum, const double start[2], int32_t max_period,
                    const int64_t *max_periods, kz_plane_ending *endings);
