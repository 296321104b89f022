/* A step of centres in pairs of doubles. */
#include "pairs_series.h"

enum { TERMS = 18 };

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

static void step_one(const kz_speed_class *speed, const kz_constant *torque, kz_sets *x, int n_cosine, vector *cosine) {
  _Alignas(VECTOR_BYTES) kz_series_of_pairs y;
  pair sine, cos, faster, farther;
  sine_of(x->theta, &sine, &cos);
  bound_sine(speed, sine.high, x);
  put_pair(x->velocity, 0, y.v, y.v_low);
  put_pair(sine, 0, y.S, y.S_low);
  put_pair(cos, 0, y.C, y.C_low);
  expand_pairs(speed, torque, 0, &y);
  expand_doubles(speed, torque, &y);
  sum_series(speed, 1, &y, &faster, &farther);
  farther = plus(farther, times(x->velocity, constant_pair(speed->step[0])));
  x->theta = plus(x->theta, farther);
  x->velocity = plus(x->velocity, faster);
  for (int n = 0; n < n_cosine; n++) cosine[n] = y.C[n];
}

void kz_centres_step_pairs(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n,
                           vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  const kz_constant *torque = &speed->torque[i * speed->order];
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
