/* Steps of the Taylor series of the pendulum's equation for a few orbits at once: the inner loops of the quad-precision reference.
 * taylor.f90 makes the forces; the loops are in C. */
#ifndef KAPITZA_TAYLOR_STEPS_H
#define KAPITZA_TAYLOR_STEPS_H

#include <stdint.h>

/* Number of orbits at once; highest order in sums of three doubles; in pairs of doubles; highest order; powers of time in a damping that changes. */
enum { KZ_TAYLOR_LANES = 8, KZ_TAYLOR_DEEP = 4, KZ_TAYLOR_FINE = 28, KZ_TAYLOR_LAST = 56, KZ_TAYLOR_RAMP = 4 };

/* A series in the time of a step, the same for all orbits: sums of two doubles, the first orders of three. */
typedef struct {
  double high[KZ_TAYLOR_LAST], low[KZ_TAYLOR_LAST], rest[KZ_TAYLOR_DEEP];
} kz_taylor_shared;

/* The force over a step h, as (h theta')' = -damping h theta' - along sin theta - across cos theta + torque in the time of the step. */
typedef struct {
  kz_taylor_shared along, across;
  double torque[3];
  double damping[3][KZ_TAYLOR_RAMP]; /* the largest parts first */
  int32_t has_across, has_ramp;      /* 1 if there are `across` and `torque`; 1 if the damping changes */
} kz_taylor_force;

/* theta (rad), h theta', sin theta, cos theta of the orbits, as sums of three doubles. */
typedef struct {
  double theta[3][KZ_TAYLOR_LANES], w[3][KZ_TAYLOR_LANES], s[3][KZ_TAYLOR_LANES], c[3][KZ_TAYLOR_LANES];
} kz_taylor_state;

/* Does the steps force [n], one after the other. well [KZ_TAYLOR_LANES] becomes 0 for an orbit whose series has not converged at the last
 * order, or is too large at the last order in pairs: it needs shorter steps, and its state is meaningless. Orbits are independent. */
void kz_taylor_steps(int64_t n, const kz_taylor_force *force, kz_taylor_state *state, int32_t *well);

#endif
