/* Taylor steps of the pendulum's equation for a few orbits at once, the inner loops of the quad-precision reference
 * (taylor.f90).
 *
 * With w = h theta', s = sin theta, c = cos theta over t = t0 + h x, 0 <= x <= 1, the scaled coefficients obey
 *   (n+1) w_(n+1) = -sum_i (d_i w_(n-i) + f_i s_(n-i) + g_i c_(n-i)) + p_n,
 *   (n+1) s_(n+1) = sum_i c_i w_(n-i),  (n+1) c_(n+1) = -sum_i s_i w_(n-i),
 * where d, f, g and p are damping, along, across and torque. Orders up to KZ_TAYLOR_DEEP are sums of three doubles, up
 * to KZ_TAYLOR_FINE of two (32 digits); higher ones, below 1e-16 of the motion, are doubles. States are sums of three
 * doubles, so that steps add up without loss. ROUGH: 20 digits, enough to measure doubles. */
#include "triples.h"

/* Orbits at once; highest order in triples; in pairs; in doubles; coefficients of a damping that changes. */
enum { KZ_TAYLOR_LANES = 8, KZ_TAYLOR_DEEP = 4, KZ_TAYLOR_FINE = 28, KZ_TAYLOR_LAST = 56, KZ_TAYLOR_DAMPING = 4 };

/* A series in the time of a step for all orbits: sums of two doubles, the first orders of three. */
typedef struct {
  double high[KZ_TAYLOR_LAST], low[KZ_TAYLOR_LAST], rest[KZ_TAYLOR_DEEP];
} kz_taylor_shared;

/* The force of a step: (h theta')' = -damping h theta' - along sin theta - across cos theta + torque in its time. */
typedef struct {
  kz_taylor_shared along, across, torque;
  double damping[3][KZ_TAYLOR_DAMPING];    /* Largest parts first */
  int32_t has_across, is_damping_changing; /* 1 with `across` and `torque`; 1 if the damping changes */
} kz_taylor_force;

/* theta (rad), h theta', sin theta, cos theta of the orbits, as sums of three doubles. */
typedef struct {
  double theta[3][KZ_TAYLOR_LANES], w[3][KZ_TAYLOR_LANES], s[3][KZ_TAYLOR_LANES], c[3][KZ_TAYLOR_LANES];
} kz_taylor_state;

enum { DEEP = KZ_TAYLOR_DEEP, FINE = KZ_TAYLOR_FINE, LAST = KZ_TAYLOR_LAST, SIZE_ORDERS = 5 };

/* Highest orders of each level; largest coefficients at `fine` and `last` relative to the orders below SIZE_ORDERS. */
typedef struct {
  int64_t deep, fine, last;
  double coarse, tolerance;
} orders;

static const orders FULL_PRECISION = {DEEP, FINE, LAST, 1e-16, 1e-33}, ROUGH = {1, 12, 32, 1e-6, 1e-20};

/* Orders of w, s or c: triples up to DEEP, pairs up to FINE, high parts of all. */
typedef struct {
  triple deep[DEEP + 1];
  pair fine[FINE + 1];
  vector coarse[LAST + 1];
} coefficients;

typedef struct {
  coefficients w, s, c;
} series;

/* 1/n to 32 digits, n = 1 .. LAST + 1: a double times n fits a long double. */
#define INVERSE(n) {1.0 / (n), (double)(1.0L - (long double)(1.0 / (n)) * (n)) / (n)}
#define INVERSES(n)                                                                                           \
  INVERSE(n), INVERSE(n + 1), INVERSE(n + 2), INVERSE(n + 3), INVERSE(n + 4), INVERSE(n + 5), INVERSE(n + 6), \
      INVERSE(n + 7)
static const double inverses[][2] = {INVERSES(1),  INVERSES(9),  INVERSES(17), INVERSES(25),
                                     INVERSES(33), INVERSES(41), INVERSES(49), INVERSE(57)};
_Static_assert(sizeof inverses / sizeof *inverses == LAST + 1, "one for each order, and one beyond");

KZ_INLINE triple inverse_triple(double sign, int64_t n) {
  return inverse_triple_with(sign, (double)n, inverses[n - 1]);
}

KZ_INLINE pair inverse_pair(double sign, int64_t n) {
  return (pair){broadcast_value(sign * inverses[n - 1][0]), broadcast_value(sign * inverses[n - 1][1])};
}

/* Order n is sign total / n. */
KZ_INLINE void set_coarse(coefficients *x, int64_t n, double sign, vector total) {
  x->coarse[n] = total * inverse_pair(sign, n).high;
}

KZ_INLINE void set_fine(coefficients *x, int64_t n, double sign, pair total) {
  x->fine[n] = multiply_pairs(quick_two_sum(total.high, total.low), inverse_pair(sign, n));
  x->coarse[n] = x->fine[n].high;
}

KZ_INLINE void set_deep(coefficients *x, int64_t n, double sign, triple total) {
  x->deep[n] = multiply_triples(renormalise_triple(total), inverse_triple(sign, n));
  x->fine[n] = upper_pair(x->deep[n]);
  x->coarse[n] = x->fine[n].high;
}

/* Vectors advanced at once: in doubles all, to hide the latency of sums. */
#define CHAINS (KZ_TAYLOR_LANES / LANES)
#define CHAINS_deep 1
#define CHAINS_fine 1
#define CHAINS_coarse CHAINS

#define EACH _Pragma("GCC unroll 4") for (int64_t j = 0; j < KZ_OF_LEVEL(CHAINS_); j++)
#define ORDER(name, i) x[j].name.KZ_LEVEL[i]
#define SHARED(name, i) KZ_OF_LEVEL(KZ_CONSTANT_)(force->name.high[i], force->name.low[i], force->name.rest[i])
#define PLAIN(name, i) KZ_OF_LEVEL(KZ_CONSTANT_)(force->name[0] i, force->name[1] i, force->name[2] i)
#define GAIN_along(total, b) EACH KZ_OF_LEVEL(accumulate_)(&total[j], SHARED(along, i), ORDER(b, n - i))
#define GAIN_across(total, b) EACH KZ_OF_LEVEL(accumulate_)(&total[j], SHARED(across, i), ORDER(b, n - i))
#define GAIN_w(total, b) EACH KZ_OF_LEVEL(accumulate_)(&total[j], ORDER(b, i), ORDER(w, n - i))
#define KZ_NEXT KZ_OF_LEVEL(next_)
#define KZ_ARGUMENTS const kz_taylor_force *force, series *x
#define KZ_SUM(total) KZ_OF_LEVEL(number_) total[KZ_OF_LEVEL(CHAINS_)] = {0}
#define KZ_TERMS for (int64_t i = 0; i <= n; i++)
#define KZ_GAIN(total, a, b) GAIN_##a(total, b)
#define KZ_DAMP(total)                                                                         \
  for (int64_t i = 0; i <= n && i < (force->is_damping_changing ? KZ_TAYLOR_DAMPING : 1); i++) \
  EACH KZ_OF_LEVEL(accumulate_)(&total[j], PLAIN(damping, [i]), ORDER(w, n - i))
#define KZ_DAMPS_LATER
#define KZ_HAS_ACROSS force->has_across
#define KZ_PUSH(total) EACH KZ_OF_LEVEL(accumulate_)(&total[j], SHARED(torque, n), KZ_OF_LEVEL(KZ_CONSTANT_)(-1, 0, 0))
#define KZ_SET(name, sign, total) EACH KZ_OF_LEVEL(set_)(&x[j].name, n + 1, sign 1.0, total[j])

#define KZ_LEVEL deep
#include "motion.inc"
#define KZ_LEVEL fine
#include "motion.inc"
#define KZ_LEVEL coarse
#include "motion.inc"

/* Sums the orders from 1 on, divided by order + 1 if `integrated`, smallest terms first. */
KZ_INLINE triple sum_of(const coefficients *x, orders of, bool integrated) {
  pair total = {broadcast_value(0), broadcast_value(0)};
  for (int64_t n = of.last; n > of.fine; n--)
    total.high += x->coarse[n] * (integrated ? inverse_pair(1, n + 1).high : broadcast_value(1));
  for (int64_t n = of.fine; n > of.deep; n--)
    total = sum_unnormalised(total, integrated ? multiply_pairs(x->fine[n], inverse_pair(1, n + 1)) : x->fine[n]);
  total = quick_two_sum(total.high, total.low);
  triple whole = {{total.high, total.low, broadcast_value(0)}};
  for (int64_t n = of.deep; n >= 1; n--)
    whole = add_triples(whole, integrated ? multiply_triples(x->deep[n], inverse_triple(1, n + 1)) : x->deep[n]);
  return whole;
}

KZ_INLINE vector absolute_value(vector x) {
  return blend_lanes(x < 0, -x, x);
}

KZ_INLINE vector larger_of(vector a, vector b) {
  return blend_lanes(a > b, a, b);
}

/* True where orders n - 2 .. n, one of which may vanish by symmetry, are at most a bound; false for NaN. */
KZ_INLINE mask is_small(const series *x, int64_t n, vector bound) {
  mask small = broadcast_value(0) == broadcast_value(0);
  for (int64_t i = n - 2; i <= n; i++)
    small &= (absolute_value(x->w.coarse[i]) <= bound) & (absolute_value(x->s.coarse[i]) <= bound) &
             (absolute_value(x->c.coarse[i]) <= bound);
  return small;
}

/* True where the series are complete at the last order, and small enough at `fine` for plain doubles. */
KZ_INLINE mask is_complete(const series *x, orders of) {
  vector motion = broadcast_value(0);
  for (int64_t i = 0; i < SIZE_ORDERS; i++)
    motion = larger_of(motion, larger_of(absolute_value(x->w.coarse[i]), absolute_value(x->s.coarse[i])));
  return is_small(x, of.fine, of.coarse * motion) & is_small(x, of.last, of.tolerance * motion);
}

KZ_INLINE bool is_any(const mask *where) {
  int64_t bits = 0;
  for (int64_t i = 0; i < KZ_TAYLOR_LANES; i++) bits |= where[i / LANES][i % LANES];
  return bits != 0;
}

KZ_INLINE triple load_triple(double (*x)[KZ_TAYLOR_LANES], int64_t first) {
  return (triple){{*(vector *)(x[0] + first), *(vector *)(x[1] + first), *(vector *)(x[2] + first)}};
}

KZ_INLINE void save_triple(triple x, double (*to)[KZ_TAYLOR_LANES], int64_t first) {
  for (int i = 0; i < 3; i++) *(vector *)(to[i] + first) = x.part[i];
}

/* Sets lanes outside of the mask to 0, so that nothing overflows. */
KZ_INLINE triple clear_unless(mask where, triple x) {
  for (int i = 0; i < 3; i++) x.part[i] = blend_lanes(where, x.part[i], broadcast_value(0));
  return x;
}

KZ_INLINE void set_order_zero(triple start, coefficients *x) {
  x->deep[0] = start;
  x->fine[0] = upper_pair(start);
  x->coarse[0] = start.part[0];
}

KZ_INLINE void begin_series(series *x, kz_taylor_state *state, int64_t first) {
  set_order_zero(load_triple(state->w, first), &x->w);
  set_order_zero(load_triple(state->s, first), &x->s);
  set_order_zero(load_triple(state->c, first), &x->c);
}

/* Adds a step to one vector of orbits, and clears those that have not converged. */
KZ_INLINE void end_step(const series *x, orders of, kz_taylor_state *state, int64_t first, mask *converged) {
  *converged &= is_complete(x, of);
  const triple theta = add_triples(load_triple(state->theta, first), x->w.deep[0]);
  save_triple(add_triples(theta, sum_of(&x->w, of, true)), state->theta, first);
  save_triple(clear_unless(*converged, add_triples(x->w.deep[0], sum_of(&x->w, of, false))), state->w, first);
  save_triple(clear_unless(*converged, add_triples(x->s.deep[0], sum_of(&x->s, of, false))), state->s, first);
  save_triple(clear_unless(*converged, add_triples(x->c.deep[0], sum_of(&x->c, of, false))), state->c, first);
}

/* Computes the orders of all vectors. */
KZ_INLINE void make_series(orders of, const kz_taylor_force *force, series *x) {
  for (int64_t j = 0; j < CHAINS; j++) {
    for (int64_t i = 0; i < of.deep; i++) next_deep(force, x + j, i);
    for (int64_t i = of.deep; i < of.fine; i++) next_fine(force, x + j, i);
  }
  for (int64_t i = of.fine; i < of.last; i++) next_coarse(force, x, i);
}

/* Advances all orbits by n steps; `converged` becomes false where a series was not complete. */
KZ_INLINE void advance_orbits(int64_t n, orders of, const kz_taylor_force *force, kz_taylor_state *state,
                              mask *converged) {
  _Alignas(64) series x[CHAINS]; /* vectors across cache lines take twice as long */
  for (int64_t step = 0; step < n && is_any(converged); step++) {
    for (int64_t j = 0; j < CHAINS; j++) begin_series(&x[j], state, j * LANES);
    make_series(of, force + step, x);
    for (int64_t j = 0; j < CHAINS; j++) end_step(x + j, of, state, j * LANES, converged + j);
  }
}

/* Advances through the steps force [n] to 33 digits, or if `rough` to 20. converged [KZ_TAYLOR_LANES] becomes 0 for an
 * orbit that needs shorter steps, because a series is too large at its last order or its last in pairs; its state is
 * void. */
void kz_taylor_steps(int64_t n, int32_t rough, const kz_taylor_force *force, kz_taylor_state *state,
                     int32_t *converged) {
  mask complete[CHAINS];
  for (int64_t j = 0; j < CHAINS; j++) complete[j] = broadcast_value(0) == broadcast_value(0);
  if (rough)
    advance_orbits(n, ROUGH, force, state, complete);
  else
    advance_orbits(n, FULL_PRECISION, force, state, complete);
  for (int64_t i = 0; i < KZ_TAYLOR_LANES; i++) converged[i] = converged[i] && complete[i / LANES][i % LANES];
}
