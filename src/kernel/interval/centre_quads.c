/* A step of centres in quad precision: the first coefficients, lane by lane, are quads; those that follow are small, and as in pairs. Each
 * operation is rounded to 113 bits, the quad library's sine and cosine are off by at most 2^-108. */
#include <quadmath.h>
#include <math.h>

#include "pairs_series.h"

enum { Q = KZ_COEFFICIENTS_QUADS };

typedef __float128 quad;

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

static void expand_quads(const kz_quad_constants *constants, const quad torque[Q], quad_series *y) {
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
static void begin_lane(const kz_speed_class *speed, const quad torque[Q], const kz_sets *x, int lane, quad_series *y,
                       kz_series_of_pairs *all) {
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

static void step_one(const kz_speed_class *speed, int32_t i, kz_sets *x, int n_cosine, vector *cosine) {
  _Alignas(VECTOR_BYTES) kz_series_of_pairs y;
  quad_series lanes[LANES];
  pair faster, farther;
  for (int lane = 0; lane < LANES; lane++) begin_lane(speed, speed->quads.torque[i], x, lane, &lanes[lane], &y);
  bound_sine(speed, y.S[0], x);
  const kz_constant *torque = &speed->torque[i * speed->order];
  expand_pairs(speed, torque, Q - 1, &y);
  expand_doubles(speed, torque, &y);
  sum_series(speed, Q, &y, &faster, &farther);
  for (int lane = 0; lane < LANES; lane++)
    if (!x->lost[lane]) end_lane(speed, &lanes[lane], faster, farther, lane, x);
  for (int n = 0; n < n_cosine; n++) cosine[n] = y.C[n];
}

void kz_centres_step_quads(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n,
                           vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  for (int p = 0; p < KZ_PARTS; p++) step_one(speed, i, &sets[p], n, cosine[p]);
}

/* (B7) 2 pi in quads is off by less than 2^-110, the angle without its turns by 2^-111. */
void kz_sets_wrap_quads(kz_sets *x) {
  vector p[2] = {same(0), same(0)};
  for (int lane = 0; lane < LANES; lane++) {
    const quad theta = join(x->theta, x->theta_rest, lane), turns = rintq(theta / (2 * M_PIq));
    if (x->lost[lane] || turns == 0) continue;
    part(fmaq(-turns, 2 * M_PIq, theta), lane, &x->theta, &x->theta_rest);
    p[0][lane] = 0x1p-110 * (1 + fabs((double)turns));
  }
  kz_sets_widen(p, x);
}
