/* Bounds of rounding in a step of a centre, from the sizes of its numbers: (B1) .. (B3) of
 * docs/explanation/bounds.md. */
#pragma once

#include "sets.h"

typedef long double real;

/* Bounds for |z| <= r around any time of a motion as fast as its class allows: |Im theta| <= y, |theta'| <= w. a, slope
 * [2]: bounds of angles and velocities of the tangent map's columns that begin with (1, 0) and (0, 1). */
typedef struct {
  real r, y, w, a[2], slope[2];
} majorant;

enum { MAJORANTS = 2400 };

/* Factors of all rounding in a step. Levels of numbers are, as precisions of steps, KZ_ENCLOSE_DOUBLES ..
 * KZ_ENCLOSE_TRIPLES; errors of a number of level l are in units of u^(l + 1), u = 2^-53. */
typedef struct {
  real sine[KZ_ENCLOSURES];                   /* (B1) Sine and cosine of a centre's angle */
  real angle[KZ_ENCLOSURES];                  /* (B1) More of it for each rad of that angle and one more */
  real start[KZ_ENCLOSURES];                  /* Relative error of the velocity with which a step begins */
  real sums[KZ_ENCLOSURES];                   /* (B2) Factor of the error of a sum of products */
  real times[KZ_ENCLOSURES];                  /* (B2) Product with a constant, and the constant */
  real factors[KZ_ENCLOSURES][KZ_ENCLOSURES]; /* [precision][level] (B2) Rounded factors of a product */
  real plus[KZ_ENCLOSURES];                   /* (B2) Sum */
  real state;                                 /* (B3) h v and the angle in doubles, in units of u^2 */
  real slack[KZ_ENCLOSURES];                  /* Slack beyond the lemmas, times slack_of_sums() */
  real higher;                                /* Terms of higher order, (1 + u)^n with n u below 1e-2 */
} kz_rounding_factors;
extern const kz_rounding_factors kz_rounding;

/* Bounds of a step. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_rounding_factors *factor;
  int n_majorants, order, precision;
  bool fits; /* True: the sizes of products are as (B2) assumes */
  real h;
  real torque[KZ_ORDER_PAIRS];                         /* Sizes of the force's powers of s */
  real velocity[KZ_ORDER_PAIRS], sine[KZ_ORDER_PAIRS]; /* Sizes of coefficients; `sine` of the cosine's too */
  real velocity_error[KZ_ORDER_PAIRS], sine_error[KZ_ORDER_PAIRS]; /* Errors of the computed coefficients */
  majorant majorant[MAJORANTS];
} kz_step_bounds;

static const real KZ_MARGIN = 1 + 1e-9L; /* Relative margin far above the rounding of bounds and of the C library */
static const real KZ_UNIT = 0x1p-53L;    /* u */
static const real KZ_TINY = 1e-280L;     /* Products below the range of doubles */

/* Number of products in the force of coefficient n + 1: damping, along, and if present across and torque. */
int kz_products_of(const kz_step_bounds *b, int n);
/* (B2) Sets the errors of the coefficients of a centre of at most `fastest` rad per drive radian, from their sizes. */
void kz_set_errors(kz_step_bounds *b, double fastest);
/* (B2), (B3) Adds the rounding of the angle (rad) and of the velocity to error[2]. */
void kz_add_rounding(const kz_step_bounds *b, double fastest, real error[2]);
