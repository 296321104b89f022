/* Sums of products of pairs, as enclosures take them, against exact sums. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "../../tools/test.h"

#include "enclosure/operations.h"

static double uniform(double low, double high) {
  return low + (high - low) * rand() / RAND_MAX;
}

/* Adds x to an exact sum of n doubles, which do not overlap (J. R. Shewchuk, Discrete Comput. Geom. 18 (1997) 305). */
static int grow(int n, double *part, double x) {
  for (int i = 0; i < n; i++) {
    const double s = part[i] + x, z = s - x;
    part[i] = (part[i] - z) + (x - (s - z));
    x = s;
  }
  part[n] = x;
  return n + 1;
}

static int grow_product(int n, double *part, double a, double b) {
  const double p = a * b;
  return grow(grow(n, part, fma(a, b, -p)), part, p);
}

/* How far a sum of n products of pairs is off, over u^2 times the sum of their sizes; `cancel`: big ones that cancel. */
static double sum_is_off(int n, bool cancel) {
  double part[1000] = {0}, size = 0;
  int parts = 0;
  products s = {same(0), same(0)};
  for (int i = 0; i < n; i++) {
    const double scale = cancel ? (i % 2 ? -1 : 1) * ldexp(1, rand() % 30) : ldexp(1, -i);
    const double a[2] = {scale * uniform(0.5, 1), 0}, b[2] = {uniform(0.5, 1), 0};
    const double low[2] = {a[0] * uniform(-0x1p-54, 0x1p-54), b[0] * uniform(-0x1p-54, 0x1p-54)};
    add_product(&s, (pair){same(a[0]), same(low[0])}, (pair){same(b[0]), same(low[1])});
    parts = grow_product(parts, part, a[0], b[0]);
    parts = grow_product(parts, part, low[0], b[0]);
    parts = grow_product(parts, part, a[0], low[1]);
    parts = grow_product(parts, part, low[0], low[1]);
    size += fabs(a[0] * b[0]);
  }
  parts = grow(grow(parts, part, -s.high[0]), part, -s.low[0]);
  double off = 0;
  for (int i = 0; i < parts; i++) off += part[i];
  return fabs(off) / (0x1p-106 * size);
}

/* (B2) */
TEST(sums_of_products_are_as_good_as_their_bound) {
  double worst = 0;
  srand(5);
  for (int i = 0; i < 20000; i++) {
    const int n = 1 + rand() % 26;
    worst = fmax(worst, sum_is_off(n, i % 2) / (n * n + 4 * n + 9));
  }
  assert_true(worst < 1 && worst > 0.1);
}
