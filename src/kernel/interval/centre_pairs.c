/* A step of centres in pairs of doubles. */
#include "operations.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS, TERMS = 18 };

OPERATION pair scaled(products s, kz_constant factor) {
  return times(sum(s.high, s.low), constant_pair(factor));
}

/* 1 + c x y. */
OPERATION pair nested(pair x, pair y, kz_constant c) {
  return plus((pair){same(1), same(0)}, times(times(x, y), constant_pair(c)));
}

/* -1 / (n (n + 1)), rounded to a pair. */
OPERATION kz_constant term(int n) {
  const double product = (double)n * (n + 1), high = -1 / product;
  return (kz_constant){high, -fma(high, product, 1) / product};
}

/* Sine and cosine, off by at most 48 u^2 (B1). */
static void sine_of(pair theta, pair *sine, pair *cosine) {
  static const double pi[3] = KZ_PI;
  const vector count = nearest_integer(theta.high * (1 / pi[0])), sign = sign_of_parity(count);
  const pair x = less_multiple(theta, count, pi), square = times(x, x);
  pair s = {same(1), same(0)}, c = s;
  for (int n = 2 * TERMS; n > 0; n -= 2) {
    s = nested(square, s, term(n));
    c = nested(square, c, term(n - 1));
  }
  s = times(s, x);
  *sine = (pair){sign * s.high, sign * s.low};
  *cosine = (pair){sign * c.high, sign * c.low};
}

/* Coefficients of the velocity, of sine and cosine: the high parts of all, and the low parts of those that are pairs; [0] is given. */
typedef struct {
  vector v[P], S[P], C[P], v_low[PAIRS], S_low[PAIRS], C_low[PAIRS];
} series;

static void expand_pairs(const kz_speed_class *speed, const kz_constant *torque, series *x) {
  for (int n = 0; n + 1 < PAIRS; n++) {
    products f = {same(0), same(0)}, s = f, c = f;
    add_product(&f, constant_pair(speed->damping), (pair){x->v[n], x->v_low[n]});
#pragma GCC unroll 1
    for (int i = n; i >= 0; i--) {
      const pair v = {x->v[i], x->v_low[i]}, sine = {x->S[n - i], x->S_low[n - i]};
      add_product(&f, constant_pair(torque[i]), sine);
      add_product(&s, v, (pair){x->C[n - i], x->C_low[n - i]});
      add_product(&c, v, sine);
    }
    const pair v = scaled(f, speed->inverse[n]), sine = scaled(s, speed->step[n]), cosine = scaled(c, speed->step[n]);
    x->v[n + 1] = -v.high;
    x->v_low[n + 1] = -v.low;
    x->S[n + 1] = sine.high;
    x->S_low[n + 1] = sine.low;
    x->C[n + 1] = -cosine.high;
    x->C_low[n + 1] = -cosine.low;
  }
}

static void expand_doubles(const kz_speed_class *speed, const kz_constant *torque, series *x) {
  for (int n = PAIRS - 1; n + 1 < P; n++) {
    vector f = same(speed->damping.high) * x->v[n], s = same(0), c = same(0);
#pragma GCC unroll 2
    for (int i = n; i >= 0; i--) {
      f = fused(same(torque[i].high), x->S[n - i], f);
      s = fused(x->v[i], x->C[n - i], s);
      c = fused(x->v[i], x->S[n - i], c);
    }
    x->v[n + 1] = f * -speed->inverse[n].high;
    x->S[n + 1] = s * speed->step[n].high;
    x->C[n + 1] = c * -speed->step[n].high;
  }
}

static void step_one(const kz_speed_class *speed, const kz_constant *torque, kz_sets *x, int n_cosine, vector *cosine) {
  _Alignas(VECTOR_BYTES) series y;
  pair sine, cos;
  sine_of(x->theta, &sine, &cos);
  bound_sine(speed, sine.high, x);
  y.v[0] = x->velocity.high;
  y.v_low[0] = x->velocity.low;
  y.S[0] = sine.high;
  y.S_low[0] = sine.low;
  y.C[0] = cos.high;
  y.C_low[0] = cos.low;
  expand_pairs(speed, torque, &y);
  expand_doubles(speed, torque, &y);
  vector faster_small = same(0), farther_small = same(0);
  for (int n = P - 1; n >= PAIRS; n--) {
    faster_small += y.v[n];
    farther_small = fused(same(speed->step[n].high), y.v[n], farther_small);
  }
  pair faster = {faster_small, same(0)}, farther = {farther_small, same(0)};
  for (int n = PAIRS - 1; n >= 0; n--) {
    const pair v = {y.v[n], y.v_low[n]};
    if (n > 0) faster = plus(faster, v);
    farther = plus(farther, times(v, constant_pair(speed->step[n])));
  }
  x->theta = plus(x->theta, farther);
  x->velocity = plus(x->velocity, faster);
  for (int n = 0; n < n_cosine; n++) cosine[n] = y.C[n];
}

void kz_centres_step_pairs(const kz_speed_class *speed, const kz_constant *torque, kz_sets *sets, int n,
                           vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(speed, torque, &sets[p], n, cosine[p]);
}

void kz_enclosure_sine_pairs(int64_t n, const double *theta, double *sine, double *cosine) {
  for (int64_t i = 0; i < n; i++) {
    pair s, c;
    sine_of((pair){same(theta[2 * i]), same(theta[2 * i + 1])}, &s, &c);
    sine[2 * i] = s.high[0];
    sine[2 * i + 1] = s.low[0];
    cosine[2 * i] = c.high[0];
    cosine[2 * i + 1] = c.low[0];
  }
}
