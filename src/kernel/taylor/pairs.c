/* One drive period of the processed splitting in pairs of doubles: its stages, and its processor, a small displacement
 * once per period. pairs_table.f90 makes the tables. */
#include "vector/pairs_arithmetic.h"

/* Angles (half-turns) and velocities (rad per drive radian), each high + low. */
typedef struct {
  double u[2][KZ_LANES];
  double v[2][KZ_LANES];
} kz_pair_lanes;

/* Half the order of the series, which bounds harmonics and powers of a displacement; number of terms of the sine. */
enum { KZ_HALF_ORDER = 7, KZ_SINE_TERMS = 15 };

/* A displacement of (u, v): of each variable, for the harmonics j = 0 .. KZ_HALF_ORDER - 1, sin(pi j u) times even
 * powers of v and cos(pi j u) times odd ones, up to 2 (KZ_HALF_ORDER - max(j, 1)); the second of `parts`, absent from
 * mirrored pendulums, cosines with even and sines with odd ones. The first `pairs` of them need low parts. */
typedef struct {
  double coefficient[2][2][KZ_HALF_ORDER][2][KZ_HALF_ORDER][2];
  int64_t pairs[2][2][KZ_HALF_ORDER][2];
  int64_t parts;
  double sine[KZ_SINE_TERMS][2]; /* sin(pi r)/r in powers of r^2 for |r| <= 1/2 */
  int64_t sine_pairs;
} kz_displacement;

/* Vectors at once, to hide the latency of the arithmetic. */
enum { CHAINS = 4 };
#define EACH _Pragma("GCC unroll 4") for (int i = 0; i < CHAINS; i++)

typedef struct {
  int64_t n_drift, n_kick, n_pairs;
} shape;

KZ_INLINE int64_t row_size(shape size) {
  return size.n_drift + 1 + size.n_kick + size.n_pairs;
}

/* u += v (d1 + d3 v^2 + ..), or if not odd d0 + d2 v^2 + ..; all but the first coefficient are small. */
KZ_INLINE void drift_pairs(shape size, bool odd, const double *row, pair *u, const pair *v) {
  EACH {
    const vector square = v[i].high * v[i].high;
    vector small = broadcast_value(0);
    for (int64_t j = size.n_drift; j >= 2; j--) small = multiply_add(small, square, broadcast_value(row[j]));
    const pair first =
        odd ? quick_two_sum(broadcast_value(row[0]), small * square) : two_sum(broadcast_value(row[0]), small * square);
    const pair step = {first.high, first.low + row[1]};
    u[i] = add_pairs(u[i], odd ? product_unnormalised(v[i], step) : step);
  }
}

/* v -= (r - r^3)(c1 + c2 r^2 + ..), r the reduced angle. ordered: every |c| is at least the sum of those after it. */
KZ_INLINE void kick_pairs(shape size, const double *row, bool ordered, const pair *u, pair *v) {
  pair r[CHAINS], q[CHAINS], p[CHAINS];
  vector even;
  const double *doubles = row + size.n_pairs;
  EACH r[i] = reduce_half_turns(u[i], &even);
  EACH q[i] = multiply_pairs(r[i], r[i]);
  EACH p[i] = (pair){broadcast_value(doubles[size.n_kick - 1]), broadcast_value(0)};
  for (int64_t j = size.n_kick - 2; j >= size.n_pairs; j--)
    EACH p[i].high = multiply_add(p[i].high, q[i].high, broadcast_value(doubles[j]));
  if (ordered)
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) EACH p[i] = ordered_horner_step(p[i], q[i], row + 2 * j);
  else
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) EACH p[i] = horner_step(p[i], q[i], row + 2 * j);
  EACH r[i] = sum_unnormalised(r[i], negate_pair(product_unnormalised(r[i], q[i])));
  EACH v[i] = add_pairs(v[i], negate_pair(product_unnormalised(r[i], p[i])));
}

/* v -= e1 + e2 r^2 + .. */
KZ_INLINE void kick_even_pairs(shape size, const double *row, const pair *u, pair *v) {
  vector even;
  const double *doubles = row + size.n_pairs;
  EACH {
    const pair r = reduce_half_turns(u[i], &even), q = multiply_pairs(r, r);
    pair p = {broadcast_value(doubles[size.n_kick - 1]), broadcast_value(0)};
    for (int64_t j = size.n_kick - 2; j >= size.n_pairs; j--)
      p.high = multiply_add(p.high, q.high, broadcast_value(doubles[j]));
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) p = horner_step(p, q, row + 2 * j);
    v[i] = add_pairs(v[i], negate_pair(p));
  }
}

static pair *load_pairs(const double *high, const double *low, pair *x) {
  EACH x[i] = (pair){*(const vector *)(high + i * LANES), *(const vector *)(low + i * LANES)};
  return x;
}

static void save_pairs(const pair *x, double *high, double *low) {
  EACH *(vector *)(high + i * LANES) = x[i].high;
  EACH *(vector *)(low + i * LANES) = x[i].low;
}

KZ_INLINE void run_stages(bool mirrored, int64_t n_stages, shape size, const double *row, const int32_t *ordered,
                          const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns) {
  const int64_t half = row_size(size), n_row = mirrored ? half : 2 * half;
  for (int64_t first = 0; first < n; first += CHAINS * LANES) {
    pair u[CHAINS], v[CHAINS];
    vector even[CHAINS];
    load_pairs(lanes->u[0] + first, lanes->u[1] + first, u);
    load_pairs(lanes->v[0] + first, lanes->v[1] + first, v);
    for (int64_t s = 0; s < n_stages; s++) {
      const double *rest = row + s * n_row + half;
      drift_pairs(size, true, row + s * n_row, u, v);
      if (!mirrored) drift_pairs(size, false, rest, u, v);
      kick_pairs(size, row + s * n_row + size.n_drift + 1, ordered[s], u, v);
      if (!mirrored) kick_even_pairs(size, rest + size.n_drift + 1, u, v);
    }
    drift_pairs(size, true, row + n_stages * n_row, u, v);
    if (!mirrored) drift_pairs(size, false, row + n_stages * n_row + half, u, v);
    EACH u[i] = reduce_half_turns(u[i], even + i);
    EACH v[i] = multiply_pairs(v[i], (pair){broadcast_value(decay[0]), broadcast_value(decay[1])});
    save_pairs(u, lanes->u[0] + first, lanes->u[1] + first);
    save_pairs(v, lanes->v[0] + first, lanes->v[1] + first);
    EACH *(vector *)(turns + first + i * LANES) = 0.5 * even[i];
  }
}

/* Advances through the stages of one period and wraps the angles to [-1, 1]; turns [n]: net turns. row [n_stages +
 * 1][n_row]: for each stage the coefficients of the drift (the first high and low, then n_drift - 1 doubles) and of the
 * kick (n_pairs high and low, then n_kick - n_pairs doubles, because those of high powers are small); the last row has
 * only the drift. ordered [n_stages]: 1 if the modulus of every pair among the coefficients of the kick is at least the
 * sum of the moduli after it. decay [2]: factor of the velocity by damping, high and low. Without mirror symmetry a row
 * goes on with as many coefficients of even polynomials (tables.inc). */
void kz_pairs_stages(int32_t mirrored, int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs,
                     const double *row, const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes,
                     double *turns) {
  const shape size = {n_drift, n_kick, n_pairs};
  if (mirrored)
    run_stages(true, n_stages, size, row, ordered, decay, n, lanes, turns);
  else
    run_stages(false, n_stages, size, row, ordered, decay, n, lanes, turns);
}

/* sin(pi r), |r| <= 1/2. */
KZ_INLINE pair sine_of_half(const kz_displacement *d, pair r) {
  return multiply_pairs(r, evaluate_pairs(KZ_SINE_TERMS, d->sine_pairs, d->sine[0], multiply_pairs(r, r)));
}

/* sin(pi u) and cos(pi u), mirror-symmetric to the bit. */
KZ_INLINE void sine_and_cosine(const kz_displacement *d, pair u, pair *sine, pair *cosine) {
  vector even;
  const pair r = reduce_half_turns(u, &even);
  const vector sign = blend_lanes(r.high < 0, broadcast_value(-1), broadcast_value(1));
  const pair size = {sign * r.high, sign * r.low},
             rest = subtract_pairs((pair){broadcast_value(1), broadcast_value(0)}, size);
  const mask far = size.high > 0.5;
  const pair folded = {blend_lanes(far, rest.high, size.high), blend_lanes(far, rest.low, size.low)};
  const pair s = sine_of_half(d, folded);
  *sine = (pair){sign * s.high, sign * s.low};
  *cosine = sine_of_half(d, subtract_pairs((pair){broadcast_value(0.5), broadcast_value(0)}, size));
}

/* Adds factor (c[0] + c[1] square + ..) to a displacement, in pairs if n_pairs > 0. */
KZ_INLINE pair add_powers(pair shift, int64_t n, int64_t n_pairs, const double *c, pair factor, pair square) {
  const pair p = evaluate_pairs(n, n_pairs, c, square);
  if (n_pairs > 0) return add_pairs(shift, product_unnormalised(factor, p));
  return (pair){shift.high, multiply_add(factor.high, p.high, shift.low)};
}

/* Adds the displacement to (u, v) of the lanes 0 .. n - 1. */
void kz_pairs_displace(const kz_displacement *d, int64_t n, kz_pair_lanes *lanes) {
  for (int64_t first = 0; first < n; first += LANES) {
    vector *const state[2][2] = {{(vector *)(lanes->u[0] + first), (vector *)(lanes->u[1] + first)},
                                 {(vector *)(lanes->v[0] + first), (vector *)(lanes->v[1] + first)}};
    const pair u = {*state[0][0], *state[0][1]}, v = {*state[1][0], *state[1][1]}, square = multiply_pairs(v, v),
               zero = {broadcast_value(0), broadcast_value(0)};
    pair sine_1, cosine_1, shift[2] = {zero, zero}, sine = zero, cosine = {broadcast_value(1), broadcast_value(0)};
    sine_and_cosine(d, u, &sine_1, &cosine_1);
    for (int64_t j = 0; j < KZ_HALF_ORDER; j++) {
      if (j > 0) {
        const pair former = sine;
        sine = add_pairs(product_unnormalised(sine, cosine_1), product_unnormalised(cosine, sine_1));
        cosine = subtract_pairs(product_unnormalised(cosine, cosine_1), product_unnormalised(former, sine_1));
      }
      const int64_t degree = 2 * (KZ_HALF_ORDER - (j > 1 ? j : 1));
      for (int64_t part = 0; part < d->parts; part++) {
        const pair factor[2] = {part ? cosine : sine, multiply_pairs(part ? sine : cosine, v)};
        for (int64_t x = 0; x < 2; x++)
          for (int64_t odd = 0; odd < 2; odd++)
            shift[x] = add_powers(shift[x], (degree - odd) / 2 + 1, d->pairs[part][x][j][odd],
                                  d->coefficient[part][x][j][odd][0], factor[odd], square);
      }
    }
    const pair moved[2] = {add_pairs(u, shift[0]), add_pairs(v, shift[1])};
    for (int x = 0; x < 2; x++) *state[x][0] = moved[x].high, *state[x][1] = moved[x].low;
  }
}
