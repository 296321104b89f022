/* Numbers as sums of three doubles, the largest first: some 48 digits, in the lanes of a vector. Every operation takes mirror images to mirror
 * images. With u = 2^-53, and |x_1| <= 1.01 u S, |x_2| <= 1.03 u^2 S for the parts of a number of size S, what each operation gives obeys this
 * with its own size, and its error is a multiple of u^3 times that size: (B2) of docs/explanation/bounds.md. */
#pragma once

#include "vector/pairs_arithmetic.h"

typedef struct {
  vector part[3];
} triple;

/* The same number: its parts may overlap before, or cancel. */
OPERATION triple in_order(triple x) {
  const pair b = sum(x.part[1], x.part[2]), a = sum(x.part[0], b.high), c = sum(a.low, b.low);
  return (triple){{a.high, c.high, c.low}};
}

/* x + y; the error is at most 9 u^3 (|x| + |y|). */
OPERATION triple add_triples(triple x, triple y) {
  const pair a = sum(x.part[0], y.part[0]), b = sum(x.part[1], y.part[1]), c = sum(b.high, a.low);
  return in_order((triple){{a.high, c.high, (x.part[2] + y.part[2]) + (b.low + c.low)}});
}

/* total += a b; its parts may overlap afterwards. */
OPERATION void gain_triple(triple *total, triple a, triple b) {
  const vector *x = a.part, *y = b.part, p = x[0] * y[0], q = x[0] * y[1], r = x[1] * y[0];
  const pair first = sum(total->part[0], p), second = sum(total->part[1], first.low),
             third = sum(second.high, fused(x[0], y[0], -p)), fourth = sum(third.high, q), fifth = sum(fourth.high, r);
  const vector small = fused(x[0], y[2], fused(x[1], y[1], fused(x[2], y[0], fused(x[0], y[1], -q) + fused(x[1], y[0], -r))));
  total->part[0] = first.high;
  total->part[1] = fifth.high;
  total->part[2] += small + ((second.low + third.low) + (fourth.low + fifth.low));
}

/* x y; the error is at most 39 u^3 |x y|. */
OPERATION triple multiply_triples(triple x, triple y) {
  triple product = {{same(0), same(0), same(0)}};
  gain_triple(&product, x, y);
  return in_order(product);
}

/* The first two of its doubles: to 32 digits. */
OPERATION pair upper(triple x) {
  return (pair){x.part[0], x.part[1]};
}

/* sign / n for an integer n whose inverse has these first two parts: what they leave of 1, over n, is the third. */
OPERATION triple inverse_with(double sign, double n, const double i[2]) {
  const double left = __builtin_fma(-i[1], n, __builtin_fma(-i[0], n, 1.0));
  return (triple){{same(sign * i[0]), same(sign * i[1]), same(sign * (left / n))}};
}

/* Series whose first orders are triples ("deep"), the next pairs ("fine"), and the last, which are small, doubles ("coarse"): motion.inc is
 * made once for each KZ_LEVEL. The operations of a level end in its name. */
#define KZ_PASTE(a, b) a##b
#define KZ_JOIN(a, b) KZ_PASTE(a, b)
#define OF_LEVEL(name) KZ_JOIN(name, KZ_LEVEL)

typedef triple number_deep;
typedef pair number_fine;
typedef vector number_coarse;
#define gain_deep gain_triple
#define gain_fine gain
OPERATION void gain_coarse(vector *total, vector a, vector b) {
  *total = fused(a, b, *total);
}
/* The number a + b + c, the same in all lanes; a level takes those that it has. */
#define made_deep(a, b, c) ((triple){{same(a), same(b), same(c)}})
#define made_fine(a, b, c) ((pair){same(a), same(b)})
#define made_coarse(a, b, c) same(a)
