/* A step of centres in pairs of doubles or in quads. The first coefficients of a centre in quads, lane by lane, are quads; each operation on
 * them is rounded to 113 bits, and the quad library's sine and cosine are off by at most 2^-108. Those that follow, and all of a centre in
 * pairs, are pairs of doubles, the later ones doubles. */
#include <quadmath.h>
#include <math.h>

#include "operations.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS, Q = KZ_COEFFICIENTS_QUADS, TERMS = 18 };

typedef __float128 quad;

OPERATION pair scaled(products s, kz_constant factor) {
  return times(sum(s.high, s.low), constant_pair(factor));
}

/* Coefficients of the velocity, of sine and cosine: the high parts of all, and the low parts of the pairs. Those of index 0 are given. */
typedef struct {
  vector v[P], S[P], C[P], v_low[PAIRS], S_low[PAIRS], C_low[PAIRS];
} series_of_pairs;

OPERATION void put_pair(pair value, int n, vector *high, vector *low) {
  high[n] = value.high;
  low[n] = value.low;
}

/* Computes the coefficients that are pairs, after coefficient `known`. */
OPERATION void expand_pairs(const kz_speed_class *speed, const kz_constant *torque, int known, series_of_pairs *x) {
  for (int n = known; n + 1 < PAIRS; n++) {
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
    put_pair((pair){-v.high, -v.low}, n + 1, x->v, x->v_low);
    put_pair(sine, n + 1, x->S, x->S_low);
    put_pair((pair){-cosine.high, -cosine.low}, n + 1, x->C, x->C_low);
  }
}

/* Computes the coefficients that are doubles. */
OPERATION void expand_doubles(const kz_speed_class *speed, const kz_constant *torque, series_of_pairs *x) {
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

/* *faster = the sum of the coefficients from `first` on, for the velocity; *farther = the same times h / (n + 1), for the angle. */
OPERATION void sum_series(const kz_speed_class *speed, int first, const series_of_pairs *y, pair *faster, pair *farther) {
  vector faster_small = same(0), farther_small = same(0);
  for (int n = P - 1; n >= PAIRS; n--) {
    faster_small += y->v[n];
    farther_small = fused(same(speed->step[n].high), y->v[n], farther_small);
  }
  *faster = (pair){faster_small, same(0)};
  *farther = (pair){farther_small, same(0)};
  for (int n = PAIRS - 1; n >= first; n--) {
    const pair v = {y->v[n], y->v_low[n]};
    *faster = plus(*faster, v);
    *farther = plus(*farther, times(v, constant_pair(speed->step[n])));
  }
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

/* Of a lane: coefficients of the velocity, of sine and cosine. */
typedef struct {
  quad v[Q], S[Q], C[Q];
} quad_series;

static quad join(pair x, vector rest, int lane) {
  return ((quad)x.high[lane] + x.low[lane]) + rest[lane];
}

static void part(quad value, int lane, pair *x, vector *rest) {
  x->high[lane] = (double)value;
  value -= x->high[lane];
  x->low[lane] = (double)value;
  (*rest)[lane] = (double)(value - x->low[lane]);
}

static void expand_quads(const kz_quad_constants *constants, const quad *torque, quad_series *y) {
  for (int n = 0; n + 1 < Q; n++) {
    quad f = constants->damping * y->v[n], s = 0, c = 0;
    for (int i = n; i >= 0; i--) {
      f += torque[i] * y->S[n - i];
      s += y->v[i] * y->C[n - i];
      c += y->v[i] * y->S[n - i];
    }
    y->v[n + 1] = -f / (n + 1);
    y->S[n + 1] = constants->step * s / (n + 1);
    y->C[n + 1] = -constants->step * c / (n + 1);
  }
}

static void put_quad(quad value, int lane, vector *high, vector *low) {
  (*high)[lane] = (double)value;
  (*low)[lane] = (double)(value - (*high)[lane]);
}

/* The quads of a lane; a lost one rests. */
static void begin_lane(const kz_speed_class *speed, const quad *torque, const kz_sets *x, int lane, quad_series *y,
                       series_of_pairs *all) {
  *y = (quad_series){.C = {1}};
  if (!x->lost[lane]) {
    y->v[0] = join(x->velocity, x->velocity_rest, lane);
    sincosq(join(x->theta, x->theta_rest, lane), &y->S[0], &y->C[0]);
    expand_quads(&speed->quads, torque, y);
  }
  for (int n = 0; n < Q; n++) {
    put_quad(y->v[n], lane, &all->v[n], &all->v_low[n]);
    put_quad(y->S[n], lane, &all->S[n], &all->S_low[n]);
    put_quad(y->C[n], lane, &all->C[n], &all->C_low[n]);
  }
}

/* The state of a lane at the end of the step, from the last coefficient to the first. */
static void end_lane(const kz_speed_class *speed, const quad_series *y, pair faster, pair farther, int lane, kz_sets *x) {
  quad v = (quad)faster.high[lane] + faster.low[lane], theta = (quad)farther.high[lane] + farther.low[lane];
  for (int n = Q - 1; n >= 0; n--) {
    if (n > 0) v += y->v[n];
    theta += y->v[n] * speed->quads.step / (n + 1);
  }
  part(join(x->theta, x->theta_rest, lane) + theta, lane, &x->theta, &x->theta_rest);
  part(y->v[0] + v, lane, &x->velocity, &x->velocity_rest);
}

OPERATION void step_one(bool quads, const kz_speed_class *speed, int32_t i, kz_sets *x, int n_cosine, vector *cosine) {
  _Alignas(VECTOR_BYTES) series_of_pairs y;
  quad_series lanes[LANES];
  pair sine, cos, faster, farther;
  const kz_constant *torque = &speed->torque[i * speed->order];
  if (quads) {
    for (int lane = 0; lane < LANES; lane++)
      begin_lane(speed, &speed->quads.torque[i * speed->order], x, lane, &lanes[lane], &y);
  } else {
    sine_of(x->theta, &sine, &cos);
    put_pair(x->velocity, 0, y.v, y.v_low);
    put_pair(sine, 0, y.S, y.S_low);
    put_pair(cos, 0, y.C, y.C_low);
  }
  bound_sine(speed, y.S[0], x);
  expand_pairs(speed, torque, quads ? Q - 1 : 0, &y);
  expand_doubles(speed, torque, &y);
  sum_series(speed, quads ? Q : 1, &y, &faster, &farther);
  if (quads) {
    for (int lane = 0; lane < LANES; lane++)
      if (!x->lost[lane]) end_lane(speed, &lanes[lane], faster, farther, lane, x);
  } else {
    farther = plus(farther, times(x->velocity, constant_pair(speed->step[0])));
    x->theta = plus(x->theta, farther);
    x->velocity = plus(x->velocity, faster);
  }
  for (int n = 0; n < n_cosine; n++) cosine[n] = y.C[n];
}

void kz_centres_step_pairs(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n,
                           vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(false, speed, i, &sets[p], n, cosine[p]);
}

void kz_centres_step_quads(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n,
                           vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(true, speed, i, &sets[p], n, cosine[p]);
}

/* (B7) The first difference is exact, and each of the four roundings that follow is at most 2^-112. */
void kz_sets_wrap_quads(kz_sets *x) {
  static const double turn[3] = KZ_TWO_PI;
  vector p[2] = {same(0), same(0)};
  for (int lane = 0; lane < LANES; lane++) {
    const quad turns = rint(x->theta.high[lane] / turn[0]);
    if (x->lost[lane] || turns == 0) continue;
    const quad near = (quad)x->theta.high[lane] - turns * turn[0];
    const quad theta = near + x->theta.low[lane] + x->theta_rest[lane] - turns * turn[1] - turns * turn[2];
    part(theta, lane, &x->theta, &x->theta_rest);
    p[0][lane] = 0x1p-109;
  }
  kz_sets_widen(p, x);
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
