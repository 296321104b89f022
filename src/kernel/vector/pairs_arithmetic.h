/* Numbers as sums of two doubles, high + low with |low| at most half a unit in the last place of high (some 32 digits),
 * in the lanes of a vector. Sums by Knuth (two_sum) and Dekker (quick_two_sum), products by fused multiply-add. Files
 * that include this are compiled without contraction. Every operation takes mirror images to mirror images. */
#pragma once

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 0
#error "pairs of doubles need products that are rounded by themselves: -ffp-contract=off (cmake/Compilers.cmake)"
#endif

#include <math.h>
#if defined __AVX512F__ || defined __FMA__
#include <immintrin.h>
#endif

#include "vector/vector.h"

enum { LANES = VECTOR_BYTES / sizeof(double) };

typedef int64_t mask __attribute__((vector_size(VECTOR_BYTES)));

typedef struct {
  vector high, low;
} pair;

/* a b + c, rounded once. */
KZ_INLINE vector multiply_add(vector a, vector b, vector c) {
#if defined __AVX512F__
  return (vector)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined __FMA__
  return (vector)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#elif defined __wasm_relaxed_simd__ /* fused, or page_fits (web/page/system.c) refuses the build */
  return (vector)__builtin_wasm_relaxed_madd_f64x2(a, b, c);
#elif defined __wasm__ /* by halves of the factors (Dekker): exact if c = -a b, else within 2^-100 before rounding */
  const vector p = a * b, s = 0x8000001p0 * a, t = 0x8000001p0 * b;
  const vector a_high = s - (s - a), b_high = t - (t - b), a_low = a - a_high, b_low = b - b_high;
  const vector low = ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low;
  const vector sum = p + c, part = sum - p;
  return sum + (((p - (sum - part)) + (c - part)) + low);
#else
  for (int i = 0; i < LANES; i++) c[i] = fma(a[i], b[i], c[i]);
  return c;
#endif
}

/* x in every lane. (x + {0} would be an addition.) */
KZ_INLINE vector broadcast_value(double x) {
#if defined __AVX512F__
  return (vector)_mm512_set1_pd(x);
#elif defined __FMA__
  return (vector)_mm256_set1_pd(x);
#else
  vector all = {0};
  for (int i = 0; i < LANES; i++) all[i] = x;
  return all;
#endif
}

/* a where the mask is set, else b. */
KZ_INLINE vector blend_lanes(mask where, vector a, vector b) {
  return (vector)((where & (mask)a) | (~where & (mask)b));
}

/* a + b, |a| >= |b| or a = 0. */
KZ_INLINE pair quick_two_sum(vector a, vector b) {
  const vector s = a + b;
  return (pair){s, b - (s - a)};
}

/* a + b. */
KZ_INLINE pair two_sum(vector a, vector b) {
  const vector s = a + b, t = s - a;
  return (pair){s, (a - (s - t)) + (b - t)};
}

/* x + y as a sum whose parts may overlap by some bits. */
KZ_INLINE pair sum_unnormalised(pair x, pair y) {
  const pair s = two_sum(x.high, y.high);
  return (pair){s.high, s.low + (x.low + y.low)};
}

/* x + y; the error is at most 2^-104 (|x| + |y|). */
KZ_INLINE pair add_pairs(pair x, pair y) {
  const pair s = sum_unnormalised(x, y);
  return quick_two_sum(s.high, s.low);
}

KZ_INLINE pair negate_pair(pair x) {
  return (pair){-x.high, -x.low};
}

KZ_INLINE pair subtract_pairs(pair x, pair y) {
  return add_pairs(x, negate_pair(y));
}

/* x y as a sum whose parts may overlap by some bits. */
KZ_INLINE pair product_unnormalised(pair x, pair y) {
  const vector p = x.high * y.high;
  return (pair){p, multiply_add(x.high, y.low, multiply_add(x.low, y.high, multiply_add(x.high, y.high, -p)))};
}

/* x y; the error is at most 6.01 u^2 |x y|, u = 2^-53: 2 and 3 from the roundings, 1 from the product of low parts. */
KZ_INLINE pair multiply_pairs(pair x, pair y) {
  const pair p = product_unnormalised(x, y);
  return quick_two_sum(p.high, p.low);
}
/* total += a b, high parts without error; the low part of the total sums rounding errors and low parts of the products,
 * without renormalisation (Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26 (2005) 1955). */
KZ_INLINE void accumulate_pair(pair *total, pair a, pair b) {
  const vector p = a.high * b.high;
  const pair t = two_sum(total->high, p);
  total->high = t.high;
  total->low += t.low + multiply_add(a.high, b.low, multiply_add(a.low, b.high, multiply_add(a.high, b.high, -p)));
}

/* x y + c, c [2] for every lane: a step of Horner's scheme. The parts may overlap by some bits. Terms with x.low come
 * last, because a chain of steps waits only for the high parts. */
KZ_INLINE pair horner_step(pair x, pair y, const double *c) {
  const vector p = x.high * y.high, rest = multiply_add(x.high, y.low, multiply_add(x.high, y.high, -p));
  const pair s = two_sum(broadcast_value(c[0]), p);
  return (pair){s.high, multiply_add(x.low, y.high, rest + (s.low + c[1]))};
}

/* x y + c for |c| >= |x y|. */
KZ_INLINE pair ordered_horner_step(pair x, pair y, const double *c) {
  const vector p = x.high * y.high, rest = multiply_add(x.high, y.low, multiply_add(x.high, y.high, -p));
  const pair s = quick_two_sum(broadcast_value(c[0]), p);
  return (pair){s.high, multiply_add(x.low, y.high, rest + (s.low + c[1]))};
}

/* c[0] + c[1] x + .. with pairs c [n][2], from n_pairs on as doubles. The parts of the result may overlap. */
KZ_INLINE pair evaluate_pairs(int64_t n, int64_t n_pairs, const double *c, pair x) {
  pair p = {broadcast_value(0), broadcast_value(0)};
  for (int64_t j = n - 1; j >= n_pairs; j--) p.high = multiply_add(p.high, x.high, broadcast_value(c[2 * j]));
  for (int64_t j = n_pairs - 1; j >= 0; j--) p = horner_step(p, x, c + 2 * j);
  return p;
}

#define KZ_ROUND_TO_EVEN 0x3p52 /* Adding it rounds to an even integer */

/* An angle in half-turns less the even integer nearest to it, in [-1, 1]; *even = that integer. */
KZ_INLINE pair reduce_half_turns(pair u, vector *even) {
  *even = (u.high + KZ_ROUND_TO_EVEN) - KZ_ROUND_TO_EVEN;
  return quick_two_sum(u.high - *even, u.low);
}
