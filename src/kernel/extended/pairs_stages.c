/* The stages of a period of the processed splitting in pairs of doubles (pairs.h). */
#include "pairs.h"
#include "pairs_arithmetic.h"

#include <stdbool.h>

/* Vectors at once: they hide the latency of the arithmetic. */
enum { CHAINS = 4 };
#define EACH _Pragma("GCC unroll 4") for (int i = 0; i < CHAINS; i++)

typedef struct {
  int64_t n_drift, n_kick, n_pairs;
} shape;

/* u += v (d1 + d3 v^2 + ..): all but d1 are small. */
OPERATION void drift(shape size, const double *row, pair *u, const pair *v) {
  EACH {
    const vector square = v[i].high * v[i].high;
    vector small = same(0);
    for (int64_t j = size.n_drift; j >= 2; j--) small = fused(small, square, same(row[j]));
    const pair rate = quick_sum(same(row[0]), small * square);
    u[i] = add(u[i], loose_product(v[i], (pair){rate.high, rate.low + row[1]}));
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

static pair *load(const double *high, const double *low, pair *x) {
  EACH x[i] = (pair){*(const vector *)(high + i * LANES), *(const vector *)(low + i * LANES)};
  return x;
}

static void save(const pair *x, double *high, double *low) {
  EACH *(vector *)(high + i * LANES) = x[i].high;
  EACH *(vector *)(low + i * LANES) = x[i].low;
}

void kz_pairs_stages(int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs, const double *row,
                     const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns) {
  const shape size = {n_drift, n_kick, n_pairs};
  const int64_t n_row = n_drift + 1 + n_kick + n_pairs;
  for (int64_t first = 0; first < n; first += CHAINS * LANES) {
    pair u[CHAINS], v[CHAINS];
    vector even[CHAINS];
    load(lanes->u[0] + first, lanes->u[1] + first, u);
    load(lanes->v[0] + first, lanes->v[1] + first, v);
    for (int64_t s = 0; s < n_stages; s++) {
      drift(size, row + s * n_row, u, v);
      kick(size, row + s * n_row + n_drift + 1, ordered[s], u, v);
    }
    drift(size, row + n_stages * n_row, u, v);
    EACH u[i] = reduce(u[i], even + i);
    EACH v[i] = multiply(v[i], (pair){same(decay[0]), same(decay[1])});
    save(u, lanes->u[0] + first, lanes->u[1] + first);
    save(v, lanes->v[0] + first, lanes->v[1] + first);
    EACH *(vector *)(turns + first + i * LANES) = 0.5 * even[i];
  }
}
