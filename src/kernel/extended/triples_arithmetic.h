/* Numbers as sums of three doubles, the largest first: some 48 digits, in the lanes of a vector. Every operation takes mirror images to
 * mirror images. */
#ifndef KAPITZA_TRIPLES_ARITHMETIC_H
#define KAPITZA_TRIPLES_ARITHMETIC_H

#include "pairs_arithmetic.h"

typedef struct {
  vector part[3];
} triple;

/* The same number: its parts may overlap before, or cancel. */
OPERATION triple in_order(triple x) {
  const pair b = sum(x.part[1], x.part[2]), a = sum(x.part[0], b.high), c = sum(a.low, b.low);
  return (triple){{a.high, c.high, c.low}};
}

/* x + y; the error is some 2^-155 (|x| + |y|). */
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

OPERATION triple multiply_triples(triple x, triple y) {
  triple product = {{same(0), same(0), same(0)}};
  gain_triple(&product, x, y);
  return in_order(product);
}

OPERATION triple negative_triple(triple x) {
  return (triple){{-x.part[0], -x.part[1], -x.part[2]}};
}

/* The first two of its doubles: to 32 digits. */
OPERATION pair upper(triple x) {
  return (pair){x.part[0], x.part[1]};
}

#endif
