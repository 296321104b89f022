/* Enclosures through a drive period.
 *
 * Let c(s) be the exact motion of the centre, A(s) its exact tangent map from the step's matrix on. A neighbour c + A z obeys
 *   dz/ds = A^-1 (0, -h (k - m cos t) R),  R = sin(c + d) - sin c - d cos c,  d = (A z)_theta,  |R| <= |sin c| d^2 / 2 + |d|^3 / 6
 * with det A = det A(0) exp(-h beta s) (Liouville). So z moves by bounded amounts. At the step's end the centre and the matrix are
 * rounded to doubles, and what they leave out goes into z as well. */
#include <math.h>
#include <stdbool.h>

#include "enclosure.h"

/* KZ_LANES sets. */
typedef struct {
  kz_lanes theta, velocity, column[2], column_velocity[2], reach[2], bend[2][2];
  kz_lanes determinant; /* lower bound of its size */
  kz_mask lost;
} sets;

/* The value of a polynomial at s = 1, and what it may be off by. */
typedef struct {
  kz_lanes mid, error;
} value;

/* Coefficients 0 .. n, with the remainder of the series. */
KZ_INLINE value sum_of(const kz_ball *series, int n, kz_lanes rest) {
  kz_lanes mid = {0}, size = {0}, mag = {0};
  for (int i = n; i >= 0; i--) {
    mid += series[i].mid;
    size += kz_abs(series[i].mid);
    mag += series[i].mag;
  }
  return (value){mid, (mag - size) + KZ_ROUNDING * mag + rest};
}

/* Upper bound of a function on the step from its series: it is off its chord by at most the coefficients from 2 on. */
KZ_INLINE kz_lanes most_of(const kz_ball *series, int n, value end, kz_lanes rest) {
  kz_lanes beyond = end.error + rest;
  for (int i = n; i >= 2; i--) beyond += series[i].mag;
  return (kz_max(series[0].mag, kz_abs(end.mid)) + beyond) * (1 + KZ_ROUNDING);
}

KZ_INLINE value velocity_of(const kz_enclosure_plan *plan, const kz_ball *slope, kz_lanes rest) {
  const value slope_end = sum_of(slope, KZ_ENCLOSURE_ORDER - 1, kz_same(0));
  const kz_lanes mid = slope_end.mid * plan->rate.mid;
  return (value){mid, (slope_end.error * plan->rate.mag + rest) * (1 + KZ_ROUNDING) + KZ_ROUNDING * kz_abs(mid)};
}

/* Sets that are not good any more are lost; a point at rest takes their place, so that nothing overflows. */
KZ_INLINE void keep(sets *x, kz_mask good) {
  x->lost |= ~good;
  const kz_lanes one = kz_chosen(good, kz_same(0), kz_same(1));
#define KEPT(member, otherwise) x->member = kz_chosen(good, x->member, otherwise)
  KEPT(theta, kz_same(0));
  KEPT(velocity, kz_same(0));
  KEPT(determinant, one);
  for (int i = 0; i < 2; i++) {
    KEPT(column[i], i == 0 ? one : kz_same(0));
    KEPT(column_velocity[i], i == 1 ? one : kz_same(0));
    KEPT(reach[i], kz_same(0));
    for (int j = 0; j < 2; j++) KEPT(bend[i][j], kz_same(0));
  }
#undef KEPT
}

/* Lower bound of |det|; a matrix without one is lost, and so is a centre that is too fast or has turned too often for its sine. */
KZ_INLINE void check(const kz_enclosure_plan *plan, sets *x, kz_mask good) {
  const kz_lanes a = x->column[0] * x->column_velocity[1], b = x->column[1] * x->column_velocity[0];
  x->determinant = kz_abs(a - b) - KZ_ROUNDING * (kz_abs(a) + kz_abs(b)) - KZ_TINY;
  keep(x, good & (x->determinant > 1e-60) & (kz_abs(x->velocity) <= plan->fastest) & (kz_abs(x->theta) < 1e9));
}

/* What z gains on the step where |z| <= reach: first the angle's part of z, then the velocity's. most: of the columns; push: upper
 * bound of h |k - m cos t| / |det|. */
KZ_INLINE void gain_of(const kz_lanes reach[2], const kz_lanes most[2], kz_lanes sine, kz_lanes push, kz_lanes gain[2]) {
  const kz_lanes d = most[0] * reach[0] + most[1] * reach[1];
  const kz_lanes rest = push * d * d * (0.5 * sine + d * (1.0 / 6)) * (1 + KZ_ROUNDING) + KZ_TINY;
  gain[0] = most[1] * rest;
  gain[1] = most[0] * rest;
}

/* The nonlinear part. A reach that is guessed for the whole step is checked: the true one begins below and does not get there. Returns
 * which sets passed. */
KZ_INLINE kz_mask bend_over(sets *x, const kz_lanes most[2], kz_lanes sine, kz_lanes push) {
  kz_lanes gain[2], guess[2];
  gain_of(x->reach, most, sine, push, gain);
  for (int i = 0; i < 2; i++) guess[i] = x->reach[i] + 2 * gain[i];
  gain_of(guess, most, sine, push, gain);
  const kz_lanes d = most[0] * guess[0] + most[1] * guess[1];
  const kz_lanes turn = push * d * (sine + 0.5 * d) * (1 + KZ_ROUNDING), growth = 2 * turn * most[0] * most[1];
  kz_mask good = growth < 0.5;
  for (int i = 0; i < 2; i++) {
    good &= x->reach[i] + gain[i] <= guess[i];
    x->reach[i] = (x->reach[i] + gain[i]) * (1 + KZ_ROUNDING);
  }
  for (int j = 0; j < 2; j++) {
    const kz_lanes along = most[0] * ((j == 0) + x->bend[0][j]) + most[1] * ((j == 1) + x->bend[1][j]);
    const kz_lanes added = turn * along / (1 - growth) * (1 + KZ_ROUNDING) + KZ_TINY;
    x->bend[0][j] += most[1] * added;
    x->bend[1][j] += most[0] * added;
  }
  return good;
}

/* (p, q) becomes the bounds of |A^-1| times it. */
KZ_INLINE void solve(const sets *x, kz_lanes *p, kz_lanes *q) {
  const kz_lanes first = kz_abs(x->column_velocity[1]) * *p + kz_abs(x->column[1]) * *q;
  const kz_lanes second = kz_abs(x->column_velocity[0]) * *p + kz_abs(x->column[0]) * *q;
  *p = first / x->determinant * (1 + KZ_ROUNDING);
  *q = second / x->determinant * (1 + KZ_ROUNDING);
}

/* The centre and the columns become the midpoints of their values; the errors move into z. */
KZ_INLINE void round_to_doubles(const kz_enclosure_plan *plan, kz_mask good, sets *x, value theta, value velocity,
                                const value column[2], const value column_velocity[2]) {
  x->theta = theta.mid;
  x->velocity = velocity.mid;
  for (int j = 0; j < 2; j++) {
    x->column[j] = column[j].mid;
    x->column_velocity[j] = column_velocity[j].mid;
  }
  check(plan, x, good);
  kz_lanes p = theta.error + column[0].error * x->reach[0] + column[1].error * x->reach[1];
  kz_lanes q = velocity.error + column_velocity[0].error * x->reach[0] + column_velocity[1].error * x->reach[1];
  solve(x, &p, &q);
  x->reach[0] = (x->reach[0] + p) * (1 + KZ_ROUNDING);
  x->reach[1] = (x->reach[1] + q) * (1 + KZ_ROUNDING);
  for (int j = 0; j < 2; j++) {
    const kz_lanes one[2] = {(j == 0) + x->bend[0][j], (j == 1) + x->bend[1][j]};
    p = column[0].error * one[0] + column[1].error * one[1];
    q = column_velocity[0].error * one[0] + column_velocity[1].error * one[1];
    solve(x, &p, &q);
    x->bend[0][j] = (x->bend[0][j] + p) * (1 + KZ_ROUNDING);
    x->bend[1][j] = (x->bend[1][j] + q) * (1 + KZ_ROUNDING);
  }
}

static void advance_step(const kz_enclosure_plan *plan, const kz_enclosure_step *step, sets *x) {
  enum { N = KZ_ENCLOSURE_ORDER };
  kz_enclosure_series s;
  kz_enclosure_expand(plan, step, &x->theta, &x->velocity, x->column, x->column_velocity, &s);
  value column[2], column_velocity[2];
  kz_lanes most[2];
  for (int j = 0; j < 2; j++) {
    const kz_lanes angle = kz_abs(x->column[j]), velocity = kz_abs(x->column_velocity[j]);
    const kz_lanes rest = plan->column_theta_rest[0] * angle + plan->column_theta_rest[1] * velocity;
    column[j] = sum_of(s.column[j], N, rest);
    column_velocity[j] =
        velocity_of(plan, s.column_slope[j], plan->column_velocity_rest[0] * angle + plan->column_velocity_rest[1] * velocity);
    most[j] = most_of(s.column[j], N, column[j], rest);
  }
  const kz_lanes sine_rest = kz_same(plan->sine_rest);
  const kz_lanes sine = most_of(s.sine, N - 1, sum_of(s.sine, N - 1, sine_rest), sine_rest);
  const kz_lanes push = step->most_torque * (1 + KZ_ROUNDING) / (plan->decay * x->determinant);
  const kz_mask good = bend_over(x, most, sine, push);
  round_to_doubles(plan, good, x, sum_of(s.theta, N, kz_same(plan->theta_rest)),
                   velocity_of(plan, s.slope, kz_same(plan->velocity_rest)), column, column_velocity);
}

static void put(const kz_enclosure *set, int lane, sets *x) {
  x->lost[lane] = isfinite(set->theta + set->velocity + set->reach[0] + set->reach[1]) ? 0 : -1;
  if (x->lost[lane]) return;
  x->theta[lane] = set->theta;
  x->velocity[lane] = set->velocity;
  for (int j = 0; j < 2; j++) {
    x->column[j][lane] = set->matrix[0][j];
    x->column_velocity[j][lane] = set->matrix[1][j];
    x->reach[j][lane] = set->reach[j];
    for (int i = 0; i < 2; i++) x->bend[i][j][lane] = set->bend[i][j];
  }
}

static void get(const sets *x, int lane, kz_enclosure *set) {
  const bool lost = x->lost[lane] != 0;
  set->theta = x->theta[lane];
  set->velocity = x->velocity[lane];
  for (int j = 0; j < 2; j++) {
    set->matrix[0][j] = x->column[j][lane];
    set->matrix[1][j] = x->column_velocity[j][lane];
    set->reach[j] = lost ? INFINITY : x->reach[j][lane];
    for (int i = 0; i < 2; i++) set->bend[i][j] = lost ? INFINITY : x->bend[i][j][lane];
  }
}

/* Whole turns are taken out, with the error of that. */
static void wrap(sets *x) {
  const double turn = 0x1.921fb54442d18p+2, turn_rest = 0x1.1a62633145c07p-52, to_integer = 0x1.8p52;
  const kz_lanes turns = (x->theta * (1 / turn) + to_integer) - to_integer;
  x->theta = (x->theta - turns * turn) - turns * turn_rest;
  kz_lanes p = KZ_ROUNDING * kz_abs(turns), q = {0};
  solve(x, &p, &q);
  x->reach[0] = (x->reach[0] + p) * (1 + KZ_ROUNDING);
  x->reach[1] = (x->reach[1] + q) * (1 + KZ_ROUNDING);
}

/* n <= KZ_LANES sets; idle lanes copy the first. */
static void advance_lanes(const kz_enclosure_plan *plan, int64_t n, kz_enclosure *set) {
  sets x = {0};
  for (int lane = 0; lane < KZ_LANES; lane++) put(&set[lane < n ? lane : 0], lane, &x);
  check(plan, &x, ~x.lost);
  for (int32_t i = 0; i < plan->n_steps; i++) advance_step(plan, &plan->steps[i], &x);
  wrap(&x);
  for (int lane = 0; lane < n; lane++) get(&x, lane, &set[lane]);
}

void kz_enclosures_advance(const kz_enclosure_plan *plan, int64_t n, kz_enclosure *set) {
  for (int64_t i = 0; i < n; i += KZ_LANES) advance_lanes(plan, n - i < KZ_LANES ? n - i : KZ_LANES, set + i);
}
