/* Sines and cosines for steps of centres, in doubles, pairs and triples, with proved errors; u = 2^-53. */
#pragma once

#include "operations.h"
#include "taylor/triples.h"

/* Numbers of terms of the series. */
enum { KZ_SINE_TERMS_DOUBLES = 12, KZ_SINE_TERMS_PAIRS = 18, KZ_SINE_TERMS_TRIPLES = 24 };

/* Sine and cosine of a pair in doubles, off by at most 8 u (B1). */
KZ_INLINE void sine_in_doubles(pair theta, vector *sine, vector *cosine) {
  static const double pi[3] = KZ_PI;
  const vector count = nearest_integer(theta.high * (1 / pi[0])), sign = sign_of_parity(count);
  const vector x = multiply_add(count, broadcast_value(-pi[0]), theta.high) - count * pi[1], square = x * x;
  vector s = broadcast_value(1), c = broadcast_value(1);
  for (int n = 2 * KZ_SINE_TERMS_DOUBLES; n > 0; n -= 2) {
    s = multiply_add(broadcast_value(-1.0 / (n * (n + 1))), square * s, broadcast_value(1));
    c = multiply_add(broadcast_value(-1.0 / ((n - 1) * n)), square * c, broadcast_value(1));
  }
  s *= x;
  *sine = sign * multiply_add(theta.low, c, s);
  *cosine = sign * multiply_add(-theta.low, s, c);
}

KZ_INLINE pair pair_of_constant(kz_constant c) {
  return KZ_CONSTANT_fine(c.high, c.low, c.rest);
}

/* 1 - x y / (n (n + 1)). */
KZ_INLINE pair nested_pairs(pair x, pair y, int n) {
  const double product = (double)n * (n + 1), high = -1 / product;
  const kz_constant c = {high, -fma(high, product, 1) / product, 0};
  return add_accurate((pair){broadcast_value(1), broadcast_value(0)},
                      multiply_pairs(multiply_pairs(x, y), pair_of_constant(c)));
}

/* Sine and cosine of a pair, off by at most 48 u^2 (B1). */
KZ_INLINE void sine_in_pairs(pair theta, pair *sine, pair *cosine) {
  static const double pi[3] = KZ_PI;
  const vector count = nearest_integer(theta.high * (1 / pi[0])), sign = sign_of_parity(count);
  const pair x = less_multiple(theta, count, pi), square = multiply_pairs(x, x);
  pair s = {broadcast_value(1), broadcast_value(0)}, c = s;
  for (int n = 2 * KZ_SINE_TERMS_PAIRS; n > 0; n -= 2) {
    s = nested_pairs(square, s, n);
    c = nested_pairs(square, c, n - 1);
  }
  s = multiply_pairs(s, x);
  *sine = (pair){sign * s.high, sign * s.low};
  *cosine = (pair){sign * c.high, sign * c.low};
}

/* x - count number, |count| <= 2^20, with an error of at most 80 u^3 (|x| + |count number|). */
KZ_INLINE triple less_multiple_of(triple x, vector count, const double number[3]) {
  accumulate_deep(&x, (triple){{count, broadcast_value(0), broadcast_value(0)}},
                  KZ_CONSTANT_deep(-number[0], -number[1], -number[2]));
  return renormalise_triple(x);
}

/* 1 - x y / (n (n + 1)) in triples. */
KZ_INLINE triple nested_triples(triple x, triple y, int n) {
  const double product = (double)n * (n + 1), high = 1 / product, i[2] = {high, fma(-high, product, 1) / product};
  return add_triples(KZ_CONSTANT_deep(1, 0, 0),
                     multiply_triples(multiply_triples(x, inverse_triple_with(-1, product, i)), y));
}

KZ_INLINE triple signed_triple(vector sign, triple x) {
  return (triple){{sign * x.part[0], sign * x.part[1], sign * x.part[2]}};
}

/* Sine and cosine of |theta| <= farthest, off by at most (500 + 160 (farthest + 1)) u^3 (B1). */
KZ_INLINE void sine_in_triples(triple theta, triple *sine, triple *cosine) {
  static const double pi[3] = KZ_PI;
  const vector count = nearest_integer(theta.part[0] * (1 / pi[0])), sign = sign_of_parity(count);
  const triple x = less_multiple_of(theta, count, pi), square = multiply_triples(x, x);
  triple s = KZ_CONSTANT_deep(1, 0, 0), c = s;
  for (int n = 2 * KZ_SINE_TERMS_TRIPLES; n > 0; n -= 2) {
    s = nested_triples(square, s, n);
    c = nested_triples(square, c, n - 1);
  }
  *sine = signed_triple(sign, multiply_triples(s, x));
  *cosine = signed_triple(sign, c);
}
