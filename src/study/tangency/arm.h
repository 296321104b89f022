/* Study `tangency`: branches of manifolds as smooth curves, and where two of them touch. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "plan.h"

/* A cycle with one real multiplier outside of the unit circle and one inside, at one value of the key. */
enum { KZ_TANGENCY_MOST_PERIOD = 32 };
typedef struct {
  int32_t period;
  double theta[KZ_TANGENCY_MOST_PERIOD], velocity[KZ_TANGENCY_MOST_PERIOD];
} kz_hinge;

/* A branch of a manifold as a curve: its point at `place` is the image, after as many returns as the whole part of `place` says, of the point
 * at the distance nearness * multiplier^(the rest) from the cycle along the eigenvector. Stable manifolds are unstable ones of reversed time. */
typedef struct {
  kz_flow *flow;
  double point[2], direction[2]; /* rad, rad per drive radian */
  double multiplier;             /* over `periods`, above 1 */
  double nearness;               /* rad */
  int32_t periods;
  int32_t reversed; /* 1 = stable */
} kz_arm;

/* A point of it: theta is wrapped. The tangent is the derivative by the place. */
typedef struct {
  double theta, velocity, tangent[2];
} kz_arm_point;

/* Makes the branch from strobe point `phase` of a cycle to one side (1 or -1); false if the cycle is no saddle. Free it with kz_arm_free. */
bool kz_arm_make(const kz_pendulum *pendulum, const kz_hinge *hinge, int32_t phase, int32_t side, bool stable, double nearness,
                 kz_arm *arm);
void kz_arm_free(kz_arm *arm);
/* Points at n places. */
void kz_arm_points(const kz_arm *arm, int64_t n, const double *place, kz_arm_point *point);
/* The branch from 1e-3 rad beside the cycle on, as a polyline. Free it with kz_arm_trace_free. */
typedef struct {
  int64_t n;
  double *place;
  kz_arm_point *point;
} kz_arm_trace;
kz_arm_trace kz_arm_trace_make(const kz_arm *arm, double length);
void kz_arm_trace_free(kz_arm_trace *trace);

/* A pair of branches at a value of the key, and places on them. */
typedef struct {
  int32_t phase, from_side, into_side;
  double from_place, into_place;
} kz_touch;
