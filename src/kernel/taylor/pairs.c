/* One drive period of the processed splitting in pairs of doubles: its stages, and its processor, a displacement that is small, so once a period
 * is enough. pairs_table.f90 makes the tables. */
#include "vector/pairs_arithmetic.h"

/* Angles (half-turns) and velocities (rad per drive radian), each high + low. */
typedef struct {
  double u[2][KZ_LANES];
  double v[2][KZ_LANES];
} kz_pair_lanes;

/* Half the order of the series, which bounds harmonics and powers of a displacement; number of terms of the sine. */
enum { KZ_HALF_ORDER = 7, KZ_SINE_TERMS = 15 };

/* A displacement of (u, v): of each variable, for the harmonics j = 0 .. KZ_HALF_ORDER - 1, sin(pi j u) times even powers of v and cos(pi j u)
 * times odd ones, up to 2 (KZ_HALF_ORDER - max(j, 1)); the second of `parts`, which mirrored pendulums have not, cosine with even and
 * sine with odd ones. Coefficients are high and low; the first `pairs` of them need both. */
typedef struct {
  double coefficient[2][2][KZ_HALF_ORDER][2][KZ_HALF_ORDER][2];
  int64_t pairs[2][2][KZ_HALF_ORDER][2];
  int64_t parts;
  double sine[KZ_SINE_TERMS][2]; /* sin(pi r)/r in powers of r^2 for |r| <= 1/2 */
  int64_t sine_pairs;
} kz_displacement;

/* Vectors at once: they hide the latency of the arithmetic. */
enum { CHAINS = 4 };
#define EACH _Pragma("GCC unroll 4") for (int i = 0; i < CHAINS; i++)

typedef struct {
  int64_t n_drift, n_kick, n_pairs;
} shape;

OPERATION int64_t row_size(shape size) {
  return size.n_drift + 1 + size.n_kick + size.n_pairs;
}

/* u += v (d1 + d3 v^2 + ..), or where not odd d0 + d2 v^2 + ..: all but the first coefficient are small. */
OPERATION void drift(shape size, bool odd, const double *row, pair *u, const pair *v) {
  EACH {
    const vector square = v[i].high * v[i].high;
    vector small = same(0);
    for (int64_t j = size.n_drift; j >= 2; j--) small = fused(small, square, same(row[j]));
    const pair first = odd ? quick_sum(same(row[0]), small * square) : sum(same(row[0]), small * square);
    const pair step = {first.high, first.low + row[1]};
    u[i] = add(u[i], odd ? loose_product(v[i], step) : step);
  }
}

/* v -= (r - r^3)(c1 + c2 r^2 + ..), r the reduced angle. ordered: every c is at least as large as those after it together. */
OPERATION void kick(shape size, const double *row, bool ordered, const pair *u, pair *v) {
  pair r[CHAINS], q[CHAINS], p[CHAINS];
  vector even;
  const double *doubles = row + size.n_pairs;
  EACH r[i] = reduce(u[i], &even);
  EACH q[i] = multiply(r[i], r[i]);
  EACH p[i] = (pair){same(doubles[size.n_kick - 1]), same(0)};
  for (int64_t j = size.n_kick - 2; j >= size.n_pairs; j--) EACH p[i].high = fused(p[i].high, q[i].high, same(doubles[j]));
  if (ordered)
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) EACH p[i] = ordered_horner(p[i], q[i], row + 2 * j);
  else
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) EACH p[i] = horner(p[i], q[i], row + 2 * j);
  EACH r[i] = loose_sum(r[i], negative(loose_product(r[i], q[i])));
  EACH v[i] = add(v[i], negative(loose_product(r[i], p[i])));
}

/* v -= e1 + e2 r^2 + .. */
OPERATION void even_kick(shape size, const double *row, const pair *u, pair *v) {
  vector even;
  const double *doubles = row + size.n_pairs;
  EACH {
    const pair r = reduce(u[i], &even), q = multiply(r, r);
    pair p = {same(doubles[size.n_kick - 1]), same(0)};
    for (int64_t j = size.n_kick - 2; j >= size.n_pairs; j--) p.high = fused(p.high, q.high, same(doubles[j]));
    for (int64_t j = size.n_pairs - 1; j >= 0; j--) p = horner(p, q, row + 2 * j);
    v[i] = add(v[i], negative(p));
  }
}

static pair *load(const double *high, const double *low, pair *x) {
  EACH x[i] = (pair){*(const vector *)(high + i * LANES), *(const vector *)(low + i * LANES)};
  return x;
}

static void save(const pair *x, double *high, double *low) {
  EACH *(vector *)(high + i * LANES) = x[i].high;
  EACH *(vector *)(low + i * LANES) = x[i].low;
}

OPERATION void run(bool mirrored, int64_t n_stages, shape size, const double *row, const int32_t *ordered, const double *decay,
                   int64_t n, kz_pair_lanes *lanes, double *turns) {
  const int64_t half = row_size(size), n_row = mirrored ? half : 2 * half;
  for (int64_t first = 0; first < n; first += CHAINS * LANES) {
    pair u[CHAINS], v[CHAINS];
    vector even[CHAINS];
    load(lanes->u[0] + first, lanes->u[1] + first, u);
    load(lanes->v[0] + first, lanes->v[1] + first, v);
    for (int64_t s = 0; s < n_stages; s++) {
      const double *rest = row + s * n_row + half;
      drift(size, true, row + s * n_row, u, v);
      if (!mirrored) drift(size, false, rest, u, v);
      kick(size, row + s * n_row + size.n_drift + 1, ordered[s], u, v);
      if (!mirrored) even_kick(size, rest + size.n_drift + 1, u, v);
    }
    drift(size, true, row + n_stages * n_row, u, v);
    if (!mirrored) drift(size, false, row + n_stages * n_row + half, u, v);
    EACH u[i] = reduce(u[i], even + i);
    EACH v[i] = multiply(v[i], (pair){same(decay[0]), same(decay[1])});
    save(u, lanes->u[0] + first, lanes->u[1] + first);
    save(v, lanes->v[0] + first, lanes->v[1] + first);
    EACH *(vector *)(turns + first + i * LANES) = 0.5 * even[i];
  }
}

/* Does the stages of one period and wraps the angles to [-1, 1]; turns [n] = the net number of turns. row [n_stages + 1][n_row]: for each
 * stage the coefficients of the drift (the first one high and low, then n_drift - 1 doubles) and of the kick (n_pairs high and low, then
 * n_kick - n_pairs doubles, because those of high powers are small); in the last row only the drift counts. ordered [n_stages]: 1 if the
 * modulus of every pair among the coefficients of the kick is at least the sum of the moduli after it. decay [2]: factor of the velocity,
 * high and low, from damping. Without mirror symmetry a row goes on with as many coefficients of even polynomials (tables.inc). */
void kz_pairs_stages(int32_t mirrored, int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs, const double *row,
                     const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns) {
  const shape size = {n_drift, n_kick, n_pairs};
  if (mirrored)
    run(true, n_stages, size, row, ordered, decay, n, lanes, turns);
  else
    run(false, n_stages, size, row, ordered, decay, n, lanes, turns);
}

/* sin(pi r), |r| <= 1/2. */
OPERATION pair near_sine(const kz_displacement *d, pair r) {
  return multiply(r, polynomial(KZ_SINE_TERMS, d->sine_pairs, d->sine[0], multiply(r, r)));
}

/* sin(pi u) and cos(pi u): the mirror image of u has the mirror image's sine and the same cosine, to the bit. */
OPERATION void sine_and_cosine(const kz_displacement *d, pair u, pair *sine, pair *cosine) {
  vector even;
  const pair r = reduce(u, &even);
  const vector sign = pick(r.high < 0, same(-1), same(1));
  const pair size = {sign * r.high, sign * r.low}, rest = subtract((pair){same(1), same(0)}, size);
  const mask far = size.high > 0.5;
  const pair folded = {pick(far, rest.high, size.high), pick(far, rest.low, size.low)};
  const pair s = near_sine(d, folded);
  *sine = (pair){sign * s.high, sign * s.low};
  *cosine = near_sine(d, subtract((pair){same(0.5), same(0)}, size));
}

/* Adds factor (c[0] + c[1] square + ..) to a displacement: in pairs where a coefficient is large enough to need them. */
OPERATION pair add_powers(pair shift, int64_t n, int64_t n_pairs, const double *c, pair factor, pair square) {
  const pair p = polynomial(n, n_pairs, c, square);
  if (n_pairs > 0) return add(shift, loose_product(factor, p));
  return (pair){shift.high, fused(factor.high, p.high, shift.low)};
}

/* Adds the displacement to (u, v) of the lanes 0 .. n - 1. */
void kz_pairs_displace(const kz_displacement *d, int64_t n, kz_pair_lanes *lanes) {
  for (int64_t first = 0; first < n; first += LANES) {
    vector *const state[2][2] = {{(vector *)(lanes->u[0] + first), (vector *)(lanes->u[1] + first)},
                                 {(vector *)(lanes->v[0] + first), (vector *)(lanes->v[1] + first)}};
    const pair u = {*state[0][0], *state[0][1]}, v = {*state[1][0], *state[1][1]}, square = multiply(v, v),
               zero = {same(0), same(0)};
    pair sine_1, cosine_1, shift[2] = {zero, zero}, sine = zero, cosine = {same(1), same(0)};
    sine_and_cosine(d, u, &sine_1, &cosine_1);
    for (int64_t j = 0; j < KZ_HALF_ORDER; j++) {
      if (j > 0) {
        const pair former = sine;
        sine = add(loose_product(sine, cosine_1), loose_product(cosine, sine_1));
        cosine = subtract(loose_product(cosine, cosine_1), loose_product(former, sine_1));
      }
      const int64_t degree = 2 * (KZ_HALF_ORDER - (j > 1 ? j : 1));
      for (int64_t part = 0; part < d->parts; part++) {
        const pair factor[2] = {part ? cosine : sine, multiply(part ? sine : cosine, v)};
        for (int64_t x = 0; x < 2; x++)
          for (int64_t odd = 0; odd < 2; odd++)
            shift[x] = add_powers(shift[x], (degree - odd) / 2 + 1, d->pairs[part][x][j][odd],
                                  d->coefficient[part][x][j][odd][0], factor[odd], square);
      }
    }
    const pair moved[2] = {add(u, shift[0]), add(v, shift[1])};
    for (int x = 0; x < 2; x++) *state[x][0] = moved[x].high, *state[x][1] = moved[x].low;
  }
}
