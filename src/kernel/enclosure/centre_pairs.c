/* A step of centres in pairs of doubles or in triples. The first coefficients of a centre in triples are triples. Those that follow, and all of
 * a centre in pairs, are pairs, the later ones doubles. */
#include "sines.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS, TRIPLES = KZ_COEFFICIENTS_TRIPLES, FINE = KZ_COEFFICIENTS_FINE };

/* The coefficients of the velocity, of sine or of cosine: of the triples and pairs their first parts too, as pairs and as doubles. */
typedef struct {
  triple deep[TRIPLES];
  pair fine[FINE];
  vector coarse[P];
} coefficients;

typedef struct {
  coefficients w, s, c;
} series;

OPERATION void put_coarse(vector x, int64_t n, coefficients *to) {
  to->coarse[n] = x;
}

OPERATION void put_fine(pair x, int64_t n, coefficients *to) {
  to->fine[n] = x;
  to->coarse[n] = x.high;
}

OPERATION void put_deep(triple x, int64_t n, coefficients *to) {
  to->deep[n] = x;
  put_fine(upper(x), n, to);
}

OPERATION vector scaled_coarse(vector s, vector factor) {
  return s * factor;
}

OPERATION pair scaled_fine(pair s, pair factor) {
  return multiply(sum(s.high, s.low), factor);
}

OPERATION triple scaled_deep(triple s, triple factor) {
  return multiply_triples(in_order(s), factor);
}

#define TERMS_deep for (int64_t i = n; i >= 0; i--)
#define TERMS_fine _Pragma("GCC unroll 1") TERMS_deep
#define TERMS_coarse _Pragma("GCC unroll 2") TERMS_deep
#define ORDER(name, i) x->name.KZ_LEVEL[i]
#define CONSTANT(sign, c) OF_LEVEL(made_)(sign(c).high, sign(c).low, sign(c).rest)
#define FACTOR_along(i) CONSTANT(, speed->along[first + (i)])
#define FACTOR_across(i) CONSTANT(, speed->across[first + (i)])
#define FACTOR_w(i) ORDER(w, i)
#define UNIT_w inverse
#define UNIT_s step
#define UNIT_c step
#define KZ_NEXT OF_LEVEL(next_)
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, series *x
#define KZ_SUM(total) OF_LEVEL(number_) total = OF_LEVEL(made_)(0, 0, 0)
#define KZ_TERMS OF_LEVEL(TERMS_)
#define KZ_GAIN(total, a, b) OF_LEVEL(gain_)(&total, ORDER(b, n - i), FACTOR_##a(i))
#define KZ_DAMP(total) OF_LEVEL(gain_)(&total, ORDER(w, n), CONSTANT(, speed->damping))
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(total) OF_LEVEL(gain_)(&total, OF_LEVEL(made_)(-1, 0, 0), CONSTANT(, speed->torque[first + n]))
#define KZ_SET(name, sign, total) \
  OF_LEVEL(put_)(OF_LEVEL(scaled_)(total, CONSTANT(sign, speed->UNIT_##name[n])), n + 1, &x->name)

#define KZ_LEVEL deep
#include "taylor/motion.inc"
#define KZ_LEVEL fine
#include "taylor/motion.inc"
#define KZ_LEVEL coarse
#include "taylor/motion.inc"

/* *faster = the sum of the coefficients from `first` on, of which `fine_ones` are more than doubles, for the velocity; *farther = the same times
 * h / (n + 1), for the angle. */
OPERATION void sum_series(const kz_speed_class *speed, int first, int fine_ones, const coefficients *w, pair *faster,
                          pair *farther) {
  vector faster_small = same(0), farther_small = same(0);
  for (int n = P - 1; n >= fine_ones; n--) {
    faster_small += w->coarse[n];
    farther_small = fused(same(speed->step[n].high), w->coarse[n], farther_small);
  }
  *faster = (pair){faster_small, same(0)};
  *farther = (pair){farther_small, same(0)};
  for (int n = fine_ones - 1; n >= first; n--) {
    *faster = plus(*faster, w->fine[n]);
    *farther = plus(*farther, multiply(w->fine[n], fine(speed->step[n])));
  }
}

OPERATION triple join(pair x, vector rest) {
  return (triple){{x.high, x.low, rest}};
}

/* The state at the end of a step in triples, from the last coefficient to the first. */
OPERATION void finish(const kz_speed_class *speed, const coefficients *w, pair faster, pair farther, kz_sets *x) {
  triple v = join(faster, same(0)), theta = join(farther, same(0));
  for (int n = TRIPLES - 1; n >= 0; n--) {
    const kz_constant h = speed->step[n];
    if (n > 0) v = add_triples(v, w->deep[n]);
    theta = add_triples(theta, multiply_triples(w->deep[n], made_deep(h.high, h.low, h.rest)));
  }
  theta = add_triples(join(x->theta, x->theta_rest), theta);
  v = add_triples(w->deep[0], v);
  x->theta = upper(theta);
  x->theta_rest = theta.part[2];
  x->velocity = upper(v);
  x->velocity_rest = v.part[2];
}

OPERATION void step_one(bool triples, const kz_speed_class *speed, int32_t i, kz_sets *x, int n_circle, kz_circle *circle) {
  _Alignas(VECTOR_BYTES) series y;
  pair faster, farther;
  const int32_t first = i * speed->order;
  const int fine_ones = triples ? FINE : PAIRS;
  if (triples) {
    triple sine, cosine;
    sine_in_triples(join(x->theta, x->theta_rest), &sine, &cosine);
    put_deep(join(x->velocity, x->velocity_rest), 0, &y.w);
    put_deep(sine, 0, &y.s);
    put_deep(cosine, 0, &y.c);
  } else {
    pair sine, cosine;
    sine_in_pairs(x->theta, &sine, &cosine);
    put_fine(x->velocity, 0, &y.w);
    put_fine(sine, 0, &y.s);
    put_fine(cosine, 0, &y.c);
  }
  x->most_sine = sine_bound(speed, y.s.coarse[0], x->velocity.high);
  for (int n = 0; triples && n + 1 < TRIPLES; n++) next_deep(speed, first, &y, n);
  for (int n = triples ? TRIPLES - 1 : 0; n + 1 < fine_ones; n++) next_fine(speed, first, &y, n);
  for (int n = fine_ones - 1; n + 1 < P; n++) next_coarse(speed, first, &y, n);
  sum_series(speed, triples ? TRIPLES : 1, fine_ones, &y.w, &faster, &farther);
  if (triples) {
    finish(speed, &y.w, faster, farther, x);
  } else {
    farther = plus(farther, multiply(x->velocity, fine(speed->step[0])));
    x->theta = plus(x->theta, farther);
    x->velocity = plus(x->velocity, faster);
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

/* (B7) */
void kz_sets_wrap_triples(kz_sets *x) {
  static const double turn[3] = KZ_TWO_PI;
  const vector turns = nearest_integer(x->theta.high * (1 / turn[0]));
  const triple theta = less_multiple_of(join(x->theta, x->theta_rest), turns, turn);
  x->theta = upper(theta);
  x->theta_rest = theta.part[2];
  const vector p[2] = {0x1p-147 * size_of(turns), same(0)};
  kz_sets_widen(p, x);
}
