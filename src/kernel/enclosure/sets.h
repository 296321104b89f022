/* Inside of the enclosures of kernel.h: sets of states in the lanes of vectors, and the constants of a class of speeds. What each bound
 * covers, and why it does, is derived in docs/explanation/bounds.md; the numbers (B1) .. (B7) are those of that page. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "kapitza/kernel_enclosure.h"
#include "vector/pairs_arithmetic.h"

/* Orders of the Taylor polynomials: of the centre in doubles; in pairs or triples; of the tangent map with new frames, where its remainder is
 * small compared with the set; of the tangent map with a kept frame. KZ_PARTS vectors are advanced together, so that the processor has
 * work while it waits for sums. */
enum { KZ_ORDER_DOUBLES = 22, KZ_ORDER_PAIRS = 40, KZ_ORDER_TANGENT = 8, KZ_ORDER_JACOBIAN = 20, KZ_PARTS = 2 };

/* Number of coefficients of a centre in pairs that are pairs; the others, below 1e-18 of the velocity, are doubles. Number of coefficients of a
 * centre in triples that are triples, and of those that are triples or pairs. */
enum { KZ_COEFFICIENTS_PAIRS = 25, KZ_COEFFICIENTS_TRIPLES = 14, KZ_COEFFICIENTS_FINE = 29 };

/* Relative margin: far above the rounding of the few operations on positive numbers in a bound. */
#define KZ_ROUND_UP (1 + 0x1p-40)

/* A real number as a sum of three doubles, each at most half a unit in the last place of the one before. */
typedef struct {
  double high, low, rest;
} kz_constant;

/* A step of 2 pi / n_steps for centres that are at most `fastest` at its beginning. Time s in steps: 0 .. 1. */
typedef struct {
  int32_t n_steps, order;
  int32_t frame_steps;                /* number of steps after which the frame is renewed */
  double fastest;                     /* rad per drive radian */
  double theta_error, velocity_error; /* (B3) of the centre, a step */
  /* (B4) of (theta, velocity), by a neighbour's (theta, velocity) at the beginning of the step: frame renewed, frame kept. */
  double tangent_error[2][2][2];
  double max_turn;                  /* (B5) rad: theta of a centre on a step, beyond h |velocity| */
  double neighbour_angle[2];        /* (B5) theta of a neighbour on the step, by the same */
  double nonlinear[2];              /* (B6) (theta, velocity) by a torque that acts for the whole step */
  bool has_across;                  /* whether there is a drive across, or a torque */
  double max_across;                /* upper bound of |b(t)| */
  double *max_torque;               /* [n_steps] upper bound of |a(t)| + |b(t)| + |torque(t)| on each step; behind the series */
  kz_constant damping;              /* h beta */
  kz_constant step[KZ_ORDER_PAIRS]; /* h / (n + 1) */
  kz_constant inverse[KZ_ORDER_PAIRS]; /* 1 / (n + 1) */
  kz_constant *across, *torque;        /* [n_steps][order] powers of s in -h b(t) and h torque(t), behind those along */
  kz_constant along[];                 /* [n_steps][order] powers of s in h a(t) */
} kz_speed_class;

struct kz_enclosure_tables {
  int32_t precision, n_classes;
  double
      speed_margin; /* rad per drive radian: a centre may use a class if it is slower than `fastest` by this at the beginning of a period */
  kz_speed_class *classes[];
};

/* LANES sets, first the numbers of kz_enclosure in their order. A centre is the sum of a pair and a rest, which is 0 except in triples. */
typedef struct {
  pair theta;
  vector theta_rest;
  pair velocity;
  vector velocity_rest;
  vector matrix[2][2], reach[2], jacobian_error[2][2];
  vector max_sine; /* upper bound of |sin theta| of the centre on the present step */
  mask too_fast, lost;
} kz_sets;
enum { KZ_SET_NUMBERS = sizeof(kz_enclosure) / sizeof(double) };
_Static_assert(offsetof(kz_sets, max_sine) == KZ_SET_NUMBERS * sizeof(vector), "a vector for each number of an enclosure");

/* Puts a set into a lane. */
KZ_INLINE void put_set(const kz_enclosure *set, int lane, kz_sets *x) {
  for (int i = 0; i < KZ_SET_NUMBERS; i++) ((vector *)x)[i][lane] = ((const double *)set)[i];
}

/* Call it before a step. It marks sets as lost that are too fast for the class, too large, or without area. */
void kz_sets_check(const kz_speed_class *speed, kz_sets *sets);
/* Coefficients of sine and cosine along centres, in doubles; those of the sine only where there is a drive across. */
typedef struct {
  vector sine[KZ_ORDER_JACOBIAN], cosine[KZ_ORDER_JACOBIAN];
} kz_circle;
/* Step i of the centres of KZ_PARTS vectors. circle = the first n coefficients along them. */
typedef void kz_centres_step(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]);
kz_centres_step kz_centres_step_doubles, kz_centres_step_pairs, kz_centres_step_triples;
/* The same step of the sets around the centres; jacobian = true updates jacobian_error too. */
void kz_neighbours_step(const kz_speed_class *speed, int32_t step, const kz_circle *circle, bool jacobian, kz_sets *sets);
/* Widens the sets by an error p of their centres. */
void kz_sets_widen(const vector p[2], kz_sets *sets);
/* Sets the rest of each centre to 0 and widens the sets by it. */
void kz_sets_drop_rest(kz_sets *sets);
/* Removes whole turns from the centres, in pairs or in triples. */
void kz_sets_wrap(kz_sets *sets);
void kz_sets_wrap_triples(kz_sets *sets);
/* Replaces each set by a rectangle around it, along its longer side. */
void kz_sets_renew_frame(kz_sets *sets);

/* A class of the given precision, for centres up to `fastest` (rad per drive radian), of so many steps; 0 = as many as make Taylor's rest small
 * beside rounding. NULL if it needs too many. */
kz_speed_class *kz_speed_class_create(const kz_pendulum *pendulum, int32_t precision, double fastest, int32_t n_steps);
/* Sets the constants of a class whose number of steps and order are set. */
void kz_speed_class_set_constants(const kz_pendulum *pendulum, kz_speed_class *speed);
KZ_INLINE vector absolute(vector x) {
  return (vector)((mask)x & INT64_MAX);
}

/* (B5) An upper bound of |sin theta| on a step: the error of `sine` is below 1e-14, and the sine changes by less than the angle. */
KZ_INLINE vector sine_bound(const kz_speed_class *speed, vector sine, vector velocity) {
  const vector most = (absolute(sine) + speed->step[0].high * absolute(velocity) + speed->max_turn + 1e-14) * KZ_ROUND_UP;
  return blend(most < 1, most, broadcast(1));
}

KZ_INLINE vector nearest_integer(vector x) {
  const double to_integer = 0x1.8p52; /* adding it rounds to an integer */
  return (x + to_integer) - to_integer;
}
