/* Numbers as sums of three doubles, the largest first (some 48 digits), in the lanes of a vector. Every operation takes
 * mirror images to mirror images. With u = 2^-53, if parts of numbers of size S obey |x_1| <= 1.01 u S, |x_2| <= 1.03
 * u^2 S, so does the result of an operation with its own size, with an error of a multiple of u^3 times that size: (B2)
 * of docs/explanation/bounds.md. */
#pragma once

#include "vector/pairs_arithmetic.h"

typedef struct {
  vector part[3];
} triple;

/* Renormalises parts that overlap or cancel. */
KZ_INLINE triple renormalise_triple(triple x) {
  const pair b = two_sum(x.part[1], x.part[2]), a = two_sum(x.part[0], b.high), c = two_sum(a.low, b.low);
  return (triple){{a.high, c.high, c.low}};
}

/* x + y; the error is at most 9 u^3 (|x| + |y|). */
KZ_INLINE triple add_triples(triple x, triple y) {
  const pair a = two_sum(x.part[0], y.part[0]), b = two_sum(x.part[1], y.part[1]), c = two_sum(b.high, a.low);
  return renormalise_triple((triple){{a.high, c.high, (x.part[2] + y.part[2]) + (b.low + c.low)}});
}

/* total += a b; its parts may overlap afterwards. */
KZ_INLINE void accumulate_deep(triple *total, triple a, triple b) {
  const vector *x = a.part, *y = b.part, p = x[0] * y[0], q = x[0] * y[1], r = x[1] * y[0];
  const pair first = two_sum(total->part[0], p), second = two_sum(total->part[1], first.low),
             third = two_sum(second.high, multiply_add(x[0], y[0], -p)), fourth = two_sum(third.high, q),
             fifth = two_sum(fourth.high, r);
  const vector small = multiply_add(
      x[0], y[2],
      multiply_add(x[1], y[1], multiply_add(x[2], y[0], multiply_add(x[0], y[1], -q) + multiply_add(x[1], y[0], -r))));
  total->part[0] = first.high;
  total->part[1] = fifth.high;
  total->part[2] += small + ((second.low + third.low) + (fourth.low + fifth.low));
}

/* x y; the error is at most 39 u^3 |x y|. */
KZ_INLINE triple multiply_triples(triple x, triple y) {
  triple product = {{broadcast_value(0), broadcast_value(0), broadcast_value(0)}};
  accumulate_deep(&product, x, y);
  return renormalise_triple(product);
}

/* Rounds to the first two doubles (32 digits). */
KZ_INLINE pair upper_pair(triple x) {
  return (pair){x.part[0], x.part[1]};
}

/* Returns sign / n for an integer n whose inverse has the first two parts i. */
KZ_INLINE triple inverse_triple_with(double sign, double n, const double i[2]) {
  const double left = __builtin_fma(-i[1], n, __builtin_fma(-i[0], n, 1.0));
  return (triple){{broadcast_value(sign * i[0]), broadcast_value(sign * i[1]), broadcast_value(sign * (left / n))}};
}

/* Levels of a series: its first orders are triples ("deep"), the next pairs ("fine"), the last, which are small,
 * doubles ("coarse"). motion.inc is compiled once for each KZ_LEVEL, whose operations end in its name. */
#define KZ_PASTE(a, b) a##b
#define KZ_JOIN(a, b) KZ_PASTE(a, b)
#define KZ_OF_LEVEL(name) KZ_JOIN(name, KZ_LEVEL)

typedef triple number_deep;
typedef pair number_fine;
typedef vector number_coarse;
KZ_INLINE void accumulate_fine(pair *total, pair a, pair b) {
  accumulate_pair(total, a, b);
}
KZ_INLINE void accumulate_coarse(vector *total, vector a, vector b) {
  *total = multiply_add(a, b, *total);
}
/* The number a + b + c in all lanes; pairs and doubles drop the last parts. */
#define KZ_CONSTANT_deep(a, b, c) ((triple){{broadcast_value(a), broadcast_value(b), broadcast_value(c)}})
#define KZ_CONSTANT_fine(a, b, c) ((pair){broadcast_value(a), broadcast_value(b)})
#define KZ_CONSTANT_coarse(a, b, c) broadcast_value(a)
