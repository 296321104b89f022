/* What rounding adds to a step of a centre, from the sizes of the numbers in it: (B1) .. (B3) of docs/explanation/bounds.md. */
#pragma once

#include <stdbool.h>

#include "kapitza/kernel_enclosure.h"
#include "sets.h"

typedef long double real;

/* Bounds for |z| <= r around any time of a motion that is as fast as its class allows there: |Im theta| <= y, |theta'| <= w. slope [2]:
 * bounds of the velocities of the tangent map's columns that begin with (1, 0) and (0, 1). */
typedef struct {
  real r, y, w, a[2], slope[2];
} majorant;

enum { MAJORANTS = 2400 };

/* Every factor of rounding in a step. Numbers are doubles, pairs or triples: KZ_ENCLOSE_DOUBLES .. KZ_ENCLOSE_TRIPLES, as the precisions of
 * steps are. An error of a number of level l is counted in units of u^(l + 1), u = 2^-53. */
typedef struct {
  real sine[KZ_ENCLOSURES];                   /* (B1) of sine and cosine of a centre's angle */
  real angle[KZ_ENCLOSURES];                  /* (B1) the same, for each rad of that angle and one more */
  real start[KZ_ENCLOSURES];                  /* of the centre's velocity: what a step takes of it, relative */
  real sums[KZ_ENCLOSURES];                   /* (B2) times what a sum of products loses */
  real times[KZ_ENCLOSURES];                  /* (B2) of a product with a constant, and of the constant */
  real factors[KZ_ENCLOSURES][KZ_ENCLOSURES]; /* [precision][level] (B2) of the factors of a product that were rounded */
  real plus[KZ_ENCLOSURES];                   /* (B2) of a sum */
  real state;                                 /* (B3) u^2: of h v and of the angle, in doubles */
  real slack[KZ_ENCLOSURES];                  /* beyond the lemmas: times slack_of_sums() */
  real higher;                                /* for what is of higher order, (1 + u)^n with n u below 1e-2 */
} kz_rounding_factors;
extern const kz_rounding_factors kz_rounding;

/* The bounds of a step. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_rounding_factors *factor;
  int n_majorants, order, precision;
  bool fits; /* whether the sizes of products are what (B2) counts on */
  real h;
  real torque[KZ_ORDER_PAIRS];                                     /* sizes of the force's powers of s */
  real velocity[KZ_ORDER_PAIRS], sine[KZ_ORDER_PAIRS];             /* sizes of coefficients; of the cosine's too */
  real velocity_error[KZ_ORDER_PAIRS], sine_error[KZ_ORDER_PAIRS]; /* of the computed ones */
  majorant majorant[MAJORANTS];
} kz_step_bounds;

static const real KZ_MARGIN = 1 + 1e-9L; /* relative, far above the rounding of the bounds and in the C library's functions */
static const real KZ_UNIT = 0x1p-53L;    /* u */
static const real KZ_TINY = 1e-280L;     /* products below the range of doubles */

/* Number of products in the force of coefficient n + 1: the damping's, and those along; those across and the torque. */
int kz_products_of(const kz_step_bounds *b, int n);
/* (B2) Sets the errors of the coefficients of a centre of at most `fastest` rad per drive radian, from their sizes. */
void kz_set_errors(kz_step_bounds *b, double fastest);
/* (B2), (B3) What rounding adds to the angle (rad) and the velocity: missed[2]. */
void kz_add_rounding(const kz_step_bounds *b, double fastest, real error[2]);
