/* Pairs of doubles with proved errors, u = 2^-53. Sums: Joldes, Muller, Popescu, ACM TOMS 44 (2017) 15res, alg. 6. */
#pragma once

#include "sets.h"

/* x + y; the error is at most 3.01 u^2 |x + y|, also after cancellation. */
KZ_INLINE pair add_accurate(pair x, pair y) {
  const pair s = two_sum(x.high, y.high), t = two_sum(x.low, y.low);
  const pair v = quick_two_sum(s.high, s.low + t.high);
  return quick_two_sum(v.high, v.low + t.low);
}

/* a b, exact. */
KZ_INLINE pair exact_product(vector a, vector b) {
  const vector p = a * b;
  return (pair){p, multiply_add(a, b, -p)};
}

/* x - count number, for the integer `count` nearest to x.high / number, |count| <= 2^20; number: its first doubles. */
KZ_INLINE pair less_multiple(pair x, vector count, const double number[3]) {
  const pair first = exact_product(count, broadcast_value(-number[0])),
             second = exact_product(count, broadcast_value(-number[1]));
  return add_accurate(add_accurate(x, first), two_sum(second.high, second.low - count * number[2]));
}

#define KZ_PI {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -0x1.f1976b7ed8fbcp-109}
#define KZ_TWO_PI {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52, -0x1.f1976b7ed8fbcp-108}

/* 1 for an even integer, -1 for an odd one. */
KZ_INLINE vector sign_of_parity(vector integer) {
  return 1 - 2 * absolute_lanes(integer - 2 * nearest_integer(0.5 * integer));
}
