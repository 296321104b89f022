/* A step of centres in pairs of doubles or in quads. The first coefficients of a centre in quads, lane by lane, are quads; each operation on
 * them is rounded to 113 bits, and the C library's sine and cosine are off by at most 2^-108. Those that follow, and all of a centre in
 * pairs, are pairs of doubles, the later ones doubles. */
#include <math.h>

#include "operations.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS, Q = KZ_COEFFICIENTS_QUADS, TERMS = 18 };

typedef __float128 quad;

OPERATION pair scaled(products s, kz_constant factor) {
  return times(sum(s.high, s.low), constant_pair(factor));
}

/* Coefficients of the velocity, of sine and cosine: the high parts of all, and the low parts of the pairs. Those of index 0 are given. */
typedef struct {
  vector w[P], s[P], c[P], w_low[PAIRS], s_low[PAIRS], c_low[PAIRS];
} series_of_pairs;

OPERATION void put_pair(pair value, int n, vector *high, vector *low) {
  high[n] = value.high;
  low[n] = value.low;
}

#define FACTOR_along(i) constant_pair(speed->along[first + (i)])
#define FACTOR_across(i) constant_pair(speed->across[first + (i)])
#define FACTOR_w(i)      \
  (pair) {               \
    x->w[i], x->w_low[i] \
  }
#define UNIT_w speed->inverse
#define UNIT_s speed->step
#define UNIT_c speed->step

OPERATION pair with_sign(int sign, pair x) {
  return sign < 0 ? (pair){-x.high, -x.low} : x;
}

/* Of the coefficients that are pairs. */
#define KZ_NEXT next_pair
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, series_of_pairs *x
#define KZ_SUM(sum) products sum = {same(0), same(0)}
#define KZ_TERMS _Pragma("GCC unroll 1") for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(sum, a, b) add_product(&sum, FACTOR_##a(i), (pair){x->b[n - i], x->b##_low[n - i]})
#define KZ_DAMP(sum) add_product(&sum, constant_pair(speed->damping), (pair){x->w[n], x->w_low[n]})
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(sum) add_product(&sum, constant_pair(speed->push), (pair){same(-1), same(0)})
#define KZ_SET(name, sign, sum) put_pair(with_sign(sign 1, scaled(sum, UNIT_##name[n])), (int)n + 1, x->name, x->name##_low)
#include "taylor/motion.inc"

#undef FACTOR_along
#undef FACTOR_across
#undef FACTOR_w
#define FACTOR_along(i) same(speed->along[first + (i)].high)
#define FACTOR_across(i) same(speed->across[first + (i)].high)
#define FACTOR_w(i) x->w[i]

/* Of the coefficients that are doubles. */
#define KZ_NEXT next_double
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, series_of_pairs *x
#define KZ_SUM(sum) vector sum = same(0)
#define KZ_TERMS _Pragma("GCC unroll 2") for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(sum, a, b) sum = fused(FACTOR_##a(i), x->b[n - i], sum)
#define KZ_DAMP(sum) sum = same(speed->damping.high) * x->w[n]
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(sum) sum -= speed->push.high
#define KZ_SET(name, sign, sum) x->name[n + 1] = sum * (sign UNIT_##name[n].high)
#include "taylor/motion.inc"

/* *faster = the sum of the coefficients from `first` on, for the velocity; *farther = the same times h / (n + 1), for the angle. */
OPERATION void sum_series(const kz_speed_class *speed, int first, const series_of_pairs *y, pair *faster, pair *farther) {
  vector faster_small = same(0), farther_small = same(0);
  for (int n = P - 1; n >= PAIRS; n--) {
    faster_small += y->w[n];
    farther_small = fused(same(speed->step[n].high), y->w[n], farther_small);
  }
  *faster = (pair){faster_small, same(0)};
  *farther = (pair){farther_small, same(0)};
  for (int n = PAIRS - 1; n >= first; n--) {
    const pair v = {y->w[n], y->w_low[n]};
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
  quad w[Q], s[Q], c[Q];
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

#undef FACTOR_along
#undef FACTOR_across
#undef FACTOR_w
#undef UNIT_w
#undef UNIT_s
#undef UNIT_c
#define FACTOR_along(i) constants->along[first + (i)]
#define FACTOR_across(i) constants->across[first + (i)]
#define FACTOR_w(i) x->w[i]
#define UNIT_w 1
#define UNIT_s constants->step
#define UNIT_c constants->step

#define KZ_NEXT next_quad
#define KZ_ARGUMENTS const kz_quad_constants *constants, bool has_across, int32_t first, quad_series *x
#define KZ_SUM(sum) quad sum = 0
#define KZ_TERMS for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(sum, a, b) sum += FACTOR_##a(i) * x->b[n - i]
#define KZ_DAMP(sum) sum = constants->damping * x->w[n]
#define KZ_HAS_ACROSS has_across
#define KZ_PUSH(sum) sum -= constants->push
#define KZ_SET(name, sign, sum) x->name[n + 1] = sign UNIT_##name * sum / (n + 1)
#include "taylor/motion.inc"

static void put_quad(quad value, int lane, vector *high, vector *low) {
  (*high)[lane] = (double)value;
  (*low)[lane] = (double)(value - (*high)[lane]);
}

/* The quads of a lane; a lost one rests. */
static void begin_lane(const kz_speed_class *speed, int32_t first, const kz_sets *x, int lane, quad_series *y,
                       series_of_pairs *all) {
  *y = (quad_series){.c = {1}};
  if (!x->lost[lane]) {
    y->w[0] = join(x->velocity, x->velocity_rest, lane);
    sincosf128(join(x->theta, x->theta_rest, lane), &y->s[0], &y->c[0]);
    for (int n = 0; n + 1 < Q; n++) next_quad(&speed->quads, speed->has_across, first, y, n);
  }
  for (int n = 0; n < Q; n++) {
    put_quad(y->w[n], lane, &all->w[n], &all->w_low[n]);
    put_quad(y->s[n], lane, &all->s[n], &all->s_low[n]);
    put_quad(y->c[n], lane, &all->c[n], &all->c_low[n]);
  }
}

/* The state of a lane at the end of the step, from the last coefficient to the first. */
static void end_lane(const kz_speed_class *speed, const quad_series *y, pair faster, pair farther, int lane, kz_sets *x) {
  quad v = (quad)faster.high[lane] + faster.low[lane], theta = (quad)farther.high[lane] + farther.low[lane];
  for (int n = Q - 1; n >= 0; n--) {
    if (n > 0) v += y->w[n];
    theta += y->w[n] * speed->quads.step / (n + 1);
  }
  part(join(x->theta, x->theta_rest, lane) + theta, lane, &x->theta, &x->theta_rest);
  part(y->w[0] + v, lane, &x->velocity, &x->velocity_rest);
}

OPERATION void step_one(bool quads, const kz_speed_class *speed, int32_t i, kz_sets *x, int n_circle, kz_circle *circle) {
  _Alignas(VECTOR_BYTES) series_of_pairs y;
  quad_series lanes[LANES];
  pair sine, cos, faster, farther;
  const int32_t first = i * speed->order;
  if (quads) {
    for (int lane = 0; lane < LANES; lane++) begin_lane(speed, first, x, lane, &lanes[lane], &y);
  } else {
    sine_of(x->theta, &sine, &cos);
    put_pair(x->velocity, 0, y.w, y.w_low);
    put_pair(sine, 0, y.s, y.s_low);
    put_pair(cos, 0, y.c, y.c_low);
  }
  x->most_sine = sine_bound(speed, y.s[0], x->velocity.high);
  for (int n = quads ? Q - 1 : 0; n + 1 < PAIRS; n++) next_pair(speed, first, &y, n);
  for (int n = PAIRS - 1; n + 1 < P; n++) next_double(speed, first, &y, n);
  sum_series(speed, quads ? Q : 1, &y, &faster, &farther);
  if (quads) {
    for (int lane = 0; lane < LANES; lane++)
      if (!x->lost[lane]) end_lane(speed, &lanes[lane], faster, farther, lane, x);
  } else {
    farther = plus(farther, times(x->velocity, constant_pair(speed->step[0])));
    x->theta = plus(x->theta, farther);
    x->velocity = plus(x->velocity, faster);
  }
  for (int n = 0; n < n_circle; n++) circle->cosine[n] = y.c[n];
  for (int n = 0; n < n_circle && speed->has_across; n++) circle->sine[n] = y.s[n];
}

void kz_centres_step_pairs(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(false, speed, i, &sets[p], n, &circle[p]);
}

void kz_centres_step_quads(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(true, speed, i, &sets[p], n, &circle[p]);
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
