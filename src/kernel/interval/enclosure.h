/* Inside of the enclosures of kernel.h: numbers with bounds, KZ_LANES at a time, and the tables of a plan. */
#ifndef KAPITZA_KERNEL_ENCLOSURE_H
#define KAPITZA_KERNEL_ENCLOSURE_H

#include "kapitza/kernel.h"

#if defined __AVX512F__
enum { KZ_LANES = 8 };
#else
enum { KZ_LANES = 4 };
#endif
typedef double kz_lanes __attribute__((vector_size(8 * KZ_LANES)));
typedef int64_t kz_mask __attribute__((vector_size(8 * KZ_LANES)));

enum { KZ_ENCLOSURE_ORDER = 14 }; /* of the Taylor polynomials */

/* Relative bound on what rounding does to a sum of at most KZ_ENCLOSURE_ORDER + 3 products, and to a few operations on it: far above
 * the (3 ORDER + 20) 2^-53 that they add up to, with fused operations or without. KZ_TINY covers underflow. */
#define KZ_ROUNDING 0x1p-44
#define KZ_TINY 1e-280

/* A real number: |x - mid| <= mag - |mid|. So |x| <= mag, and products of midpoints and of magnitudes bound a product. */
typedef struct {
  double mid, mag;
} kz_bounded;
typedef struct {
  kz_lanes mid, mag;
} kz_ball;

/* One step of a plan: sums over powers of s = 0 .. 1, time from the beginning of the step in units of the step. */
typedef struct {
  kz_bounded torque[KZ_ENCLOSURE_ORDER + 1]; /* h^2 (k - m cos t) */
  double most_torque;                        /* upper bound of h |k - m cos t| on the step */
} kz_enclosure_step;

struct kz_enclosure_plan {
  int32_t n_steps;
  kz_bounded step, rate, damping; /* h, 1 / h, h beta */
  double decay;                   /* lower bound of exp(-h beta) */
  double fastest;                 /* rad per drive radian: of the centres */
  /* Remainders of the polynomials on a step, for a column of 1 in the angle and one of 1 in the velocity: */
  double theta_rest, velocity_rest, sine_rest;
  double column_theta_rest[2], column_velocity_rest[2];
  kz_enclosure_step steps[];
};

/* Taylor coefficients of a motion and of its linear neighbours over a step. */
typedef struct {
  kz_ball theta[KZ_ENCLOSURE_ORDER + 1], slope[KZ_ENCLOSURE_ORDER + 1]; /* slope: of d(theta)/ds */
  kz_ball sine[KZ_ENCLOSURE_ORDER + 1], cosine[KZ_ENCLOSURE_ORDER + 1];
  kz_ball stiffness[KZ_ENCLOSURE_ORDER + 1];                                          /* h^2 (k - m cos t) cos theta */
  kz_ball column[2][KZ_ENCLOSURE_ORDER + 1], column_slope[2][KZ_ENCLOSURE_ORDER + 1]; /* angles of the neighbours */
} kz_enclosure_series;

/* The series from exact angles (rad), velocities (rad per drive radian) and columns of the matrix. */
void kz_enclosure_expand(const kz_enclosure_plan *plan, const kz_enclosure_step *step, const kz_lanes *theta,
                         const kz_lanes *velocity, const kz_lanes column[2], const kz_lanes column_velocity[2],
                         kz_enclosure_series *series);

/* Sine and cosine of angles: radians, up to some thousand turns. */
void kz_enclosure_sine(const kz_lanes *angle, kz_ball *sine, kz_ball *cosine);

#define KZ_INLINE static inline __attribute__((always_inline))

KZ_INLINE kz_lanes kz_abs(kz_lanes x) {
  return (kz_lanes)((kz_mask)x & INT64_MAX);
}

KZ_INLINE kz_lanes kz_chosen(kz_mask first, kz_lanes a, kz_lanes b) {
  return (kz_lanes)((first & (kz_mask)a) | (~first & (kz_mask)b));
}

KZ_INLINE kz_lanes kz_max(kz_lanes a, kz_lanes b) {
  return kz_chosen(a > b, a, b);
}

KZ_INLINE kz_lanes kz_same(double x) {
  return x + (kz_lanes){0};
}

#endif
