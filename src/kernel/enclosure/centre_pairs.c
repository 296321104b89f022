/* A step of centres in pairs of doubles or in triples. The coefficients of a centre in triples begin as triples; then,
 * as those of a centre in pairs, they are pairs, and at last doubles. */
#include "sines.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS };
enum { TRIPLES = KZ_COEFFICIENTS_TRIPLES, FINE = KZ_COEFFICIENTS_FINE };

/* Coefficients of the velocity, of sine or of cosine; triples and pairs are also kept as pairs and doubles. */
typedef struct {
  triple deep[TRIPLES];
  pair fine[FINE];
  vector coarse[P];
} coefficients;

typedef struct {
  coefficients w, s, c;
} series;

KZ_INLINE void put_coarse(vector x, int64_t n, coefficients *to) {
  to->coarse[n] = x;
}

KZ_INLINE void put_fine(pair x, int64_t n, coefficients *to) {
  to->fine[n] = x;
  to->coarse[n] = x.high;
}

KZ_INLINE void put_deep(triple x, int64_t n, coefficients *to) {
  to->deep[n] = x;
  put_fine(upper_pair(x), n, to);
}

KZ_INLINE vector scaled_coarse(vector s, vector factor) {
  return s * factor;
}

KZ_INLINE pair scaled_fine(pair s, pair factor) {
  return multiply_pairs(two_sum(s.high, s.low), factor);
}

KZ_INLINE triple scaled_deep(triple s, triple factor) {
  return multiply_triples(renormalise_triple(s), factor);
}

#define TERMS_deep for (int64_t i = n; i >= 0; i--)
#define TERMS_fine _Pragma("GCC unroll 1") TERMS_deep
#define TERMS_coarse _Pragma("GCC unroll 2") TERMS_deep
#define ORDER(name, i) x->name.KZ_LEVEL[i]
#define CONSTANT(sign, c) KZ_OF_LEVEL(KZ_CONSTANT_)(sign(c).high, sign(c).low, sign(c).rest)
#define FACTOR_along(i) CONSTANT(, speed->along[first + (i)])
#define FACTOR_across(i) CONSTANT(, speed->across[first + (i)])
#define FACTOR_w(i) ORDER(w, i)
#define UNIT_w inverse
#define UNIT_s step
#define UNIT_c step
#define KZ_NEXT KZ_OF_LEVEL(next_)
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, series *x
#define KZ_SUM(total) KZ_OF_LEVEL(number_) total = KZ_OF_LEVEL(KZ_CONSTANT_)(0, 0, 0)
#define KZ_TERMS KZ_OF_LEVEL(TERMS_)
#define KZ_GAIN(total, a, b) KZ_OF_LEVEL(accumulate_)(&total, ORDER(b, n - i), FACTOR_##a(i))
#define KZ_DAMP(total) KZ_OF_LEVEL(accumulate_)(&total, ORDER(w, n), CONSTANT(, speed->damping))
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(total) \
  KZ_OF_LEVEL(accumulate_)(&total, KZ_OF_LEVEL(KZ_CONSTANT_)(-1, 0, 0), CONSTANT(, speed->torque[first + n]))
#define KZ_SET(name, sign, total) \
  KZ_OF_LEVEL(put_)(KZ_OF_LEVEL(scaled_)(total, CONSTANT(sign, speed->UNIT_##name[n])), n + 1, &x->name)

#define KZ_LEVEL deep
#include "taylor/motion.inc"
#define KZ_LEVEL fine
#include "taylor/motion.inc"
#define KZ_LEVEL coarse
#include "taylor/motion.inc"

/* Sums coefficients from `first` on, `fine_ones` of them fine: *d_velocity, and times h / (n + 1) *d_theta. */
KZ_INLINE void sum_series(const kz_speed_class *speed, int first, int fine_ones, const coefficients *w,
                          pair *d_velocity, pair *d_theta) {
  vector d_velocity_small = broadcast_value(0), d_theta_small = broadcast_value(0);
  for (int n = P - 1; n >= fine_ones; n--) {
    d_velocity_small += w->coarse[n];
    d_theta_small = multiply_add(broadcast_value(speed->step[n].high), w->coarse[n], d_theta_small);
  }
  *d_velocity = (pair){d_velocity_small, broadcast_value(0)};
  *d_theta = (pair){d_theta_small, broadcast_value(0)};
  for (int n = fine_ones - 1; n >= first; n--) {
    *d_velocity = add_accurate(*d_velocity, w->fine[n]);
    *d_theta = add_accurate(*d_theta, multiply_pairs(w->fine[n], pair_of_constant(speed->step[n])));
  }
}

KZ_INLINE triple triple_of(pair x, vector rest) {
  return (triple){{x.high, x.low, rest}};
}

/* The state at the end of a step in triples, from the last coefficient to the first. */
KZ_INLINE void end_step(const kz_speed_class *speed, const coefficients *w, pair d_velocity, pair d_theta, kz_sets *x) {
  triple v = triple_of(d_velocity, broadcast_value(0)), theta = triple_of(d_theta, broadcast_value(0));
  for (int n = TRIPLES - 1; n >= 0; n--) {
    const kz_constant h = speed->step[n];
    if (n > 0) v = add_triples(v, w->deep[n]);
    theta = add_triples(theta, multiply_triples(w->deep[n], KZ_CONSTANT_deep(h.high, h.low, h.rest)));
  }
  theta = add_triples(triple_of(x->theta, x->theta_rest), theta);
  v = add_triples(w->deep[0], v);
  x->theta = upper_pair(theta);
  x->theta_rest = theta.part[2];
  x->velocity = upper_pair(v);
  x->velocity_rest = v.part[2];
}

KZ_INLINE void step_one(bool triples, const kz_speed_class *speed, int32_t i, kz_sets *x, int n_circle,
                        kz_circle *circle) {
  _Alignas(VECTOR_BYTES) series y;
  pair d_velocity, d_theta;
  const int32_t first = i * speed->order;
  const int fine_ones = triples ? FINE : PAIRS;
  if (triples) {
    triple sine, cosine;
    sine_in_triples(triple_of(x->theta, x->theta_rest), &sine, &cosine);
    put_deep(triple_of(x->velocity, x->velocity_rest), 0, &y.w);
    put_deep(sine, 0, &y.s);
    put_deep(cosine, 0, &y.c);
  } else {
    pair sine, cosine;
    sine_in_pairs(x->theta, &sine, &cosine);
    put_fine(x->velocity, 0, &y.w);
    put_fine(sine, 0, &y.s);
    put_fine(cosine, 0, &y.c);
  }
  x->max_sine = sine_bound(speed, y.s.coarse[0], x->velocity.high);
  for (int n = 0; triples && n + 1 < TRIPLES; n++) next_deep(speed, first, &y, n);
  for (int n = triples ? TRIPLES - 1 : 0; n + 1 < fine_ones; n++) next_fine(speed, first, &y, n);
  for (int n = fine_ones - 1; n + 1 < P; n++) next_coarse(speed, first, &y, n);
  sum_series(speed, triples ? TRIPLES : 1, fine_ones, &y.w, &d_velocity, &d_theta);
  if (triples) {
    end_step(speed, &y.w, d_velocity, d_theta, x);
  } else {
    d_theta = add_accurate(d_theta, multiply_pairs(x->velocity, pair_of_constant(speed->step[0])));
    x->theta = add_accurate(x->theta, d_theta);
    x->velocity = add_accurate(x->velocity, d_velocity);
  }
  for (int n = 0; n < n_circle; n++) circle->cosine[n] = y.c.coarse[n];
  for (int n = 0; n < n_circle && speed->has_across; n++) circle->sine[n] = y.s.coarse[n];
}

void kz_centres_step_pairs(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(false, speed, i, &sets[p], n, &circle[p]);
}

void kz_centres_step_triples(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(true, speed, i, &sets[p], n, &circle[p]);
}

/* Removes whole turns in triples, with the error of (B7). */
void kz_sets_wrap_triples(kz_sets *x) {
  static const double turn[3] = KZ_TWO_PI;
  const vector turns = nearest_integer(x->theta.high * (1 / turn[0]));
  const triple theta = less_multiple_of(triple_of(x->theta, x->theta_rest), turns, turn);
  x->theta = upper_pair(theta);
  x->theta_rest = theta.part[2];
  const vector p[2] = {0x1p-147 * absolute_lanes(turns), broadcast_value(0)};
  kz_sets_widen(p, x);
}
