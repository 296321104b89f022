/* Sums of products of pairs and triples, as enclosures take them, against exact sums; their sines against those in many
 * digits. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "../../tools/test.h"

#include "digits/number.h"
#include "enclosure/sines.h"

static double sums_uniform(double low, double high) {
  return low + (high - low) * rand() / RAND_MAX;
}

/* Adds x to an exact sum of n doubles, which do not overlap (J. R. Shewchuk, Discrete Comput. Geom. 18 (1997) 305). */
static int sums_grow(int n, double *part, double x) {
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
  return sums_grow(sums_grow(n, part, fma(a, b, -p)), part, p);
}

/* How far a sum of n products of pairs is off, over u^2 times the sum of their sizes; `cancel`: big ones that
 * cancel. */
static double sum_is_off(int n, bool cancel) {
  double part[1000] = {0}, size = 0;
  int parts = 0;
  pair s = {broadcast_value(0), broadcast_value(0)};
  for (int i = 0; i < n; i++) {
    const double scale = cancel ? (i % 2 ? -1 : 1) * ldexp(1, rand() % 30) : ldexp(1, -i);
    const double a[2] = {scale * sums_uniform(0.5, 1), 0}, b[2] = {sums_uniform(0.5, 1), 0};
    const double low[2] = {a[0] * sums_uniform(-0x1p-54, 0x1p-54), b[0] * sums_uniform(-0x1p-54, 0x1p-54)};
    accumulate_pair(&s, (pair){broadcast_value(a[0]), broadcast_value(low[0])},
                    (pair){broadcast_value(b[0]), broadcast_value(low[1])});
    parts = grow_product(parts, part, a[0], b[0]);
    parts = grow_product(parts, part, low[0], b[0]);
    parts = grow_product(parts, part, a[0], low[1]);
    parts = grow_product(parts, part, low[0], low[1]);
    size += fabs(a[0] * b[0]);
  }
  parts = sums_grow(sums_grow(parts, part, -s.high[0]), part, -s.low[0]);
  double off = 0;
  for (int i = 0; i < parts; i++) off += part[i];
  return fabs(off) / (0x1p-106 * size);
}

/* Errors of triples over u^3. */
static double sum_of_triples_is_off(int n, bool cancel) {
  double part[1000] = {0}, size = 0, off = 0;
  int parts = 0;
  triple s = KZ_CONSTANT_deep(0, 0, 0);
  for (int i = 0; i < n; i++) {
    const double scale = cancel ? (i % 2 ? -1 : 1) * ldexp(1, rand() % 30) : ldexp(1, -i);
    double a[3] = {scale * sums_uniform(0.5, 1)}, b[3] = {sums_uniform(0.5, 1)};
    for (int k = 1; k < 3; k++)
      a[k] = a[k - 1] * sums_uniform(-0x1p-54, 0x1p-54), b[k] = b[k - 1] * sums_uniform(-0x1p-54, 0x1p-54);
    accumulate_deep(&s, KZ_CONSTANT_deep(a[0], a[1], a[2]), KZ_CONSTANT_deep(b[0], b[1], b[2]));
    for (int k = 0; k < 9; k++) parts = grow_product(parts, part, a[k / 3], b[k % 3]);
    size += fabs(a[0] * b[0]);
  }
  s = renormalise_triple(s);
  for (int k = 0; k < 3; k++) parts = sums_grow(parts, part, -s.part[k][0]);
  for (int i = 0; i < parts; i++) off += part[i];
  return fabs(off) / (0x1p-159 * size);
}

/* (B2) */
TEST(sums_of_products_are_as_good_as_their_bound) {
  double worst = 0, worst_triples = 0;
  srand(5);
  for (int i = 0; i < 20000; i++) {
    const int n = 1 + rand() % 26;
    worst = fmax(worst, sum_is_off(n, i % 2) / (n * n + 4 * n + 9));
    if (n <= 15)
      worst_triples =
          fmax(worst_triples, sum_of_triples_is_off(n, i % 2) / (4.1 * n * n * n + 25 * n * n + 42 * n + 29));
  }
  assert_true(worst < 1 && worst > 0.1);
  assert_true(worst_triples < 1 && worst_triples > 1e-3);
}

/* Angles anywhere, and next to multiples of pi/2, up to a hundred turns away. */
static void angle_at(int i, double theta[2]) {
  const double turns = i % 3 ? 0 : 100;
  theta[0] = i % 2 ? sums_uniform(-M_PI - 6 * turns, M_PI + 6 * turns)
                   : M_PI / 2 * (rand() % 400 - 200) + sums_uniform(-1, 1) * exp(-sums_uniform(0, 40));
  theta[1] = theta[0] * sums_uniform(-0x1p-54, 0x1p-54);
}

/* sine [n], cosine [n] less those of the sum of theta [n], over 2^-53n. */
static double sine_is_off(int n, const double *theta, const double *sine, const double *cosine) {
  KZ_NUMBER(x);
  KZ_NUMBER(part);
  KZ_NUMBER(s);
  KZ_NUMBER(c);
  for (int i = 0; i < n; i++) {
    kz_number_of_double(theta[i], &part);
    kz_number_add(&x, &x, &part, 300);
  }
  kz_number_sin_cos(&x, &s, &c, 300);
  for (int i = 0; i < n; i++) {
    kz_number_of_double(sine[i], &part);
    kz_number_subtract(&s, &s, &part, 300);
    kz_number_of_double(cosine[i], &part);
    kz_number_subtract(&c, &c, &part, 300);
  }
  return ldexp(fmax(fabs(kz_number_double(&s)), fabs(kz_number_double(&c))), 53 * n);
}

/* (B1): 8 and 48 units of rounding are not passed, and a tenth of them is; in triples 500 and 160 for each rad. */
TEST(sines_are_as_good_as_their_bounds) {
  double worst = 0, worst_pair = 0, worst_triple = 0;
  srand(4);
  for (int i = 0; i < 100000; i++) {
    double theta[3], sine[3], cosine[3];
    angle_at(i, theta);
    theta[2] = theta[1] * sums_uniform(-0x1p-54, 0x1p-54);
    __float128 exact[2];
    sincosf128((__float128)theta[0] + theta[1], &exact[0], &exact[1]);
    const pair angle = {broadcast_value(theta[0]), broadcast_value(theta[1])};
    vector s, c;
    sine_in_doubles(angle, &s, &c);
    worst = fmax(worst, fmax(fabs((double)(s[0] - exact[0])), fabs((double)(c[0] - exact[1]))));
    if (i % 10 != 0) continue;
    pair sines, cosines;
    sine_in_pairs(angle, &sines, &cosines);
    worst_pair = fmax(worst_pair, sine_is_off(2, theta, (double[]){sines.high[0], sines.low[0]},
                                              (double[]){cosines.high[0], cosines.low[0]}));
    triple sines3, cosines3;
    sine_in_triples(KZ_CONSTANT_deep(theta[0], theta[1], theta[2]), &sines3, &cosines3);
    for (int k = 0; k < 3; k++) sine[k] = sines3.part[k][0], cosine[k] = cosines3.part[k][0];
    worst_triple = fmax(worst_triple, sine_is_off(3, theta, sine, cosine) / (500 + 160 * (fabs(theta[0]) + 1)));
  }
  assert_true(worst < 0x8p-53 && worst > 0.1 * 0x8p-53);
  assert_true(worst_pair < 0x30 && worst_triple < 1);
}
