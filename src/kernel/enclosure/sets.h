/* Enclosures: sets of states in the lanes of vectors, and the constants of a class of speeds.
 * docs/explanation/bounds.md derives the bounds (B1) .. (B7). */
#pragma once

#include "kapitza/kernel_enclosure.h"
#include "vector/pairs_arithmetic.h"

/* Orders of the Taylor polynomials: of the centre in doubles; in pairs or triples; of the tangent map with new frames,
 * where its remainder is small beside the set; of the tangent map with a kept frame. KZ_PARTS: vectors at once. */
enum { KZ_ORDER_DOUBLES = 22, KZ_ORDER_PAIRS = 40, KZ_ORDER_TANGENT = 8, KZ_ORDER_JACOBIAN = 20, KZ_PARTS = 2 };

/* Number of coefficients of a centre in pairs that are pairs, the others being doubles below 1e-18 of the velocity;
 * number of coefficients of a centre in triples that are triples; that are triples or pairs. */
enum { KZ_COEFFICIENTS_PAIRS = 25, KZ_COEFFICIENTS_TRIPLES = 14, KZ_COEFFICIENTS_FINE = 29 };

/* Relative margin far above the rounding of the few operations on positive numbers in a bound. */
#define KZ_ROUND_UP (1 + 0x1p-40)

/* A real number as a sum of three doubles, each at most half a unit in the last place of the one before. */
typedef struct {
  double high, low, rest;
} kz_constant;

/* A class of speeds: steps of 2 pi / n_steps for centres of at most `fastest` at their beginning. Time s: 0 .. 1. */
typedef struct {
  int32_t n_steps, order;
  int32_t frame_steps;                /* Steps after which the frame is renewed */
  double fastest;                     /* Largest speed, rad per drive radian */
  double theta_error, velocity_error; /* (B3) Errors of the centre per step */
  /* (B4) Errors of the tangent map, [kept frame][theta, velocity][theta, velocity at the beginning] */
  double tangent_error[2][2][2];
  double max_turn;                     /* (B5) Change of a centre's theta on a step beyond h |velocity|, rad */
  double neighbour_angle[2];           /* (B5) Largest theta of a neighbour by its first (theta, velocity) */
  double nonlinear[2];                 /* (B6) (theta, velocity) by a unit torque on the whole step */
  bool has_across;                     /* True: there is a drive across, or a torque */
  double max_across;                   /* Upper bound of |b(t)| */
  double *max_torque;                  /* [n_steps] Upper bound of |a(t)| + |b(t)| + |torque(t)| on each step */
  kz_constant damping;                 /* h beta */
  kz_constant step[KZ_ORDER_PAIRS];    /* h / (n + 1) */
  kz_constant inverse[KZ_ORDER_PAIRS]; /* 1 / (n + 1) */
  kz_constant *across, *torque;        /* [n_steps][order] Powers of s in -h b(t) and h torque(t) */
  kz_constant along[]; /* [n_steps][order] Powers of s in h a(t); then those of across, torque, max_torque */
} kz_speed_class;

struct kz_enclosure_tables {
  int32_t precision, n_classes;
  double speed_margin; /* Speed by which a centre must be below `fastest` at the beginning of a period */
  kz_speed_class *classes[];
};

/* LANES sets, first the numbers of kz_enclosure in their order. Centres are pairs plus a rest, 0 except in triples. */
typedef struct {
  pair theta;
  vector theta_rest;
  pair velocity;
  vector velocity_rest;
  vector matrix[2][2], reach[2], jacobian_error[2][2];
  vector max_sine; /* Upper bound of |sin theta| of the centre on the present step */
  mask too_fast, lost;
} kz_sets;
enum { KZ_SET_NUMBERS = sizeof(kz_enclosure) / sizeof(double) };
_Static_assert(offsetof(kz_sets, max_sine) == KZ_SET_NUMBERS * sizeof(vector), "a vector for each number");

/* Puts a set into a lane. */
KZ_INLINE void put_set(const kz_enclosure *set, int lane, kz_sets *x) {
  for (int i = 0; i < KZ_SET_NUMBERS; i++) ((vector *)x)[i][lane] = ((const double *)set)[i];
}

/* Marks sets that are too fast for the class, too large, or without area as lost. Call it before a step. */
void kz_sets_check(const kz_speed_class *speed, kz_sets *sets);
/* Coefficients of sine and cosine along centres, in doubles; the sine is set only with a drive across. */
typedef struct {
  vector sine[KZ_ORDER_JACOBIAN], cosine[KZ_ORDER_JACOBIAN];
} kz_circle;
/* Advances the centres of KZ_PARTS vectors through step i. circle takes the first n coefficients. */
typedef void kz_centres_step(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]);
kz_centres_step kz_centres_step_doubles, kz_centres_step_pairs, kz_centres_step_triples;
/* Advances the sets around the centres through the same step; jacobian = true updates jacobian_error too. */
void kz_neighbours_step(const kz_speed_class *speed, int32_t step, const kz_circle *circle, bool jacobian, kz_sets *x);
/* Widens the sets by an error p of their centres. */
void kz_sets_widen(const vector p[2], kz_sets *sets);
/* Sets the rest of each centre to 0 and widens the sets by it. */
void kz_sets_drop_rest(kz_sets *sets);
/* Removes whole turns from the centres, in pairs or in triples. */
void kz_sets_wrap(kz_sets *sets);
void kz_sets_wrap_triples(kz_sets *sets);
/* Replaces each set by a rectangle around it, along its longer side. */
void kz_sets_renew_frame(kz_sets *sets);

/* Makes a class of the given precision for centres up to `fastest` (rad per drive radian) with n_steps steps; 0 =
 * enough to make Taylor's remainder small beside rounding. Returns NULL if it needs too many. */
kz_speed_class *kz_speed_class_create(const kz_pendulum *pendulum, int32_t precision, double fastest, int32_t n_steps);
/* Sets the constants of a class whose number of steps and order are set. */
void kz_speed_class_set_constants(const kz_pendulum *pendulum, kz_speed_class *speed);
KZ_INLINE vector absolute_lanes(vector x) {
  return (vector)((mask)x & INT64_MAX);
}

/* (B5) Upper bound of |sin theta| on a step: `sine` has an error below 1e-14, and changes by less than the angle. */
KZ_INLINE vector sine_bound(const kz_speed_class *speed, vector sine, vector v) {
  const vector most =
      (absolute_lanes(sine) + speed->step[0].high * absolute_lanes(v) + speed->max_turn + 1e-14) * KZ_ROUND_UP;
  return blend_lanes(most < 1, most, broadcast_value(1));
}

KZ_INLINE vector nearest_integer(vector x) {
  const double to_integer = 0x1.8p52; /* adding it rounds to an integer */
  return (x + to_integer) - to_integer;
}
