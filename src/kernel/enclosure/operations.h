/* Pairs of doubles with proved errors, u = 2^-53. Sums: Joldes, Muller, Popescu, ACM TOMS 44 (2017) 15res, algorithm 6. */
#ifndef KAPITZA_KERNEL_ENCLOSURE_OPERATIONS_H
#define KAPITZA_KERNEL_ENCLOSURE_OPERATIONS_H

#include "sets.h"

/* x + y; the error is at most 3.01 u^2 |x + y|, also after cancellation. */
OPERATION pair plus(pair x, pair y) {
  const pair s = sum(x.high, y.high), t = sum(x.low, y.low);
  const pair v = quick_sum(s.high, s.low + t.high);
  return quick_sum(v.high, v.low + t.low);
}

/* x y; the error is at most 6.01 u^2 |x y|: 2 and 3 from the two roundings, 1 from the product of the low parts. */
OPERATION pair times(pair x, pair y) {
  const vector p = x.high * y.high, error = fused(x.high, y.high, -p);
  return quick_sum(p, fused(x.high, y.low, fused(x.low, y.high, error)));
}

OPERATION pair constant_pair(kz_constant c) {
  return (pair){same(c.high), same(c.low)};
}

/* a b, exact. */
OPERATION pair exact_product(vector a, vector b) {
  const vector p = a * b;
  return (pair){p, fused(a, b, -p)};
}

/* x less a multiple of a number given by its first three doubles; x.high / number is within 1/2 of the integer `count`, |count| <= 2^20. */
OPERATION pair less_multiple(pair x, vector count, const double number[3]) {
  const pair first = exact_product(count, same(-number[0])), second = exact_product(count, same(-number[1]));
  return plus(plus(x, first), sum(second.high, second.low - count * number[2]));
}

/* A partial sum of products; `low` sums its rounding errors and the low parts of the products (Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26
 * (2005) 1955). The error of a sum of n products is at most (n^2 + 4 n + 9) u^2 times the sum of their moduli (B2). */
typedef struct {
  vector high, low;
} products;

OPERATION void add_product(products *to, pair a, pair b) {
  const pair p = exact_product(a.high, b.high);
  const pair s = sum(to->high, p.high);
  to->high = s.high;
  to->low += s.low + fused(a.low, b.high, fused(a.high, b.low, p.low));
}

#define KZ_PI {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -0x1.f1976b7ed8fbcp-109}
#define KZ_TWO_PI {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52, -0x1.f1976b7ed8fbcp-108}

/* 1 for an even integer, -1 for an odd one. */
OPERATION vector sign_of_parity(vector integer) {
  return 1 - 2 * size_of(integer - 2 * nearest_integer(0.5 * integer));
}

#endif
