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

OPERATION int64_t row_size(shape size) {
  return size.n_drift + 1 + size.n_kick + size.n_pairs;
}

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

/* u += d0 + d2 v^2 + ..: all but d0 are small. */
OPERATION void even_drift(shape size, const double *row, pair *u, const pair *v) {
  EACH {
    const vector square = v[i].high * v[i].high;
    vector small = same(0);
    for (int64_t j = size.n_drift; j >= 2; j--) small = fused(small, square, same(row[j]));
    const pair step = sum(same(row[0]), small * square);
    u[i] = add(u[i], (pair){step.high, step.low + row[1]});
  }
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
      drift(size, row + s * n_row, u, v);
      if (!mirrored) even_drift(size, rest, u, v);
      kick(size, row + s * n_row + size.n_drift + 1, ordered[s], u, v);
      if (!mirrored) even_kick(size, rest + size.n_drift + 1, u, v);
    }
    drift(size, row + n_stages * n_row, u, v);
    if (!mirrored) even_drift(size, row + n_stages * n_row + half, u, v);
    EACH u[i] = reduce(u[i], even + i);
    EACH v[i] = multiply(v[i], (pair){same(decay[0]), same(decay[1])});
    save(u, lanes->u[0] + first, lanes->u[1] + first);
    save(v, lanes->v[0] + first, lanes->v[1] + first);
    EACH *(vector *)(turns + first + i * LANES) = 0.5 * even[i];
  }
}

void kz_pairs_stages(int32_t mirrored, int64_t n_stages, int64_t n_drift, int64_t n_kick, int64_t n_pairs, const double *row,
                     const int32_t *ordered, const double *decay, int64_t n, kz_pair_lanes *lanes, double *turns) {
  const shape size = {n_drift, n_kick, n_pairs};
  if (mirrored)
    run(true, n_stages, size, row, ordered, decay, n, lanes, turns);
  else
    run(false, n_stages, size, row, ordered, decay, n, lanes, turns);
}
