/* Taylor series of a centre. The first coefficients are pairs of doubles, the later ones doubles. */
#ifndef KAPITZA_KERNEL_INTERVAL_PAIRS_SERIES_H
#define KAPITZA_KERNEL_INTERVAL_PAIRS_SERIES_H

#include "operations.h"

enum { P = KZ_ORDER_PAIRS, PAIRS = KZ_COEFFICIENTS_PAIRS };

OPERATION pair scaled(products s, kz_constant factor) {
  return times(sum(s.high, s.low), constant_pair(factor));
}

/* Coefficients of the velocity, of sine and cosine: the high parts of all, and the low parts of the pairs. Those of index 0 are given. */
typedef struct {
  vector v[P], S[P], C[P], v_low[PAIRS], S_low[PAIRS], C_low[PAIRS];
} kz_series_of_pairs;

OPERATION void put_pair(pair value, int n, vector *high, vector *low) {
  high[n] = value.high;
  low[n] = value.low;
}

/* Computes the coefficients that are pairs, after coefficient `known`. */
OPERATION void expand_pairs(const kz_speed_class *speed, const kz_constant *torque, int known, kz_series_of_pairs *x) {
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
OPERATION void expand_doubles(const kz_speed_class *speed, const kz_constant *torque, kz_series_of_pairs *x) {
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
OPERATION void sum_series(const kz_speed_class *speed, int first, const kz_series_of_pairs *y, pair *faster, pair *farther) {
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

#endif
