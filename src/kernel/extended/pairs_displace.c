/* The processor of the splitting in pairs of doubles (pairs.h): a displacement that is small, so once a period is enough. */
#include "pairs.h"
#include "pairs_arithmetic.h"

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
