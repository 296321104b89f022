/* Products of matrices and of polynomials in pairs of doubles: pair_products.f90. */
#include "vector/pairs_arithmetic.h"

#include <string.h>

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "quads are read by their bits, the lower half first"
#endif

/* The bits of a quad from the highest: 1 of sign, 15 of the exponent, 112 of the number after its first. */
typedef unsigned __int128 bits;

enum { QUAD_BIAS = 16383, BIAS = 1023, REST = 112 - 52 /* Bits of a quad beyond those of a double */ };

/* Exponent below which a quad counts as 0. Quads beyond the range of doubles, and NaN, become infinite. */
enum { LEAST_EXPONENT = -900 };

static double of_bits(uint64_t b) {
  double x;
  memcpy(&x, &b, sizeof x);
  return x;
}

static uint64_t bits_of(double x) {
  uint64_t b;
  memcpy(&b, &x, sizeof b);
  return b;
}

/* Splits quads x[i] into high[i] + low[i], the first 53 bits and the rest, with a relative error of some 2^-106. */
void kz_pairs_split(int64_t n, const int64_t *x, double *high, double *low) {
  for (int64_t i = 0; i < n; i++) {
    const uint64_t lower = (uint64_t)x[2 * i], higher = (uint64_t)x[2 * i + 1];
    const uint64_t sign = higher >> 63 << 63;
    const int exponent = (int)(higher >> 48 & 0x7fff) - QUAD_BIAS;
    const uint64_t first = (higher & 0xffffffffffff) << 4 | lower >> REST, rest = lower & ((UINT64_C(1) << REST) - 1);
    high[i] = exponent < LEAST_EXPONENT ? 0 : of_bits(sign | UINT64_C(0x7ff) << 52);
    low[i] = 0;
    if (exponent < LEAST_EXPONENT || exponent > BIAS) continue;
    const double top = of_bits(sign | (uint64_t)(exponent + BIAS) << 52 | first);
    const double bottom = (double)(int64_t)rest * of_bits(sign | (uint64_t)(exponent - 112 + BIAS) << 52);
    high[i] = top + bottom;
    low[i] = bottom - (high[i] - top);
  }
}

/* Joins high[i] + low[i], |low| at most half a unit in the last place of high, to quads x[i], cut after 113 bits. */
void kz_pairs_join(int64_t n, const double *high, const double *low, int64_t *x) {
  for (int64_t i = 0; i < n; i++) {
    const uint64_t h = bits_of(high[i]), l = bits_of(low[i]), whole = UINT64_C(1) << 52, sign = h >> 63;
    const int exponent = (int)(h >> 52 & 0x7ff), further = exponent - (int)(l >> 52 & 0x7ff);
    if (exponent == 0 || exponent == 0x7ff) {
      x[2 * i] = 0, x[2 * i + 1] = (int64_t)(sign << 63 | (exponent ? UINT64_C(0x7fff) << 48 : 0));
      continue;
    }
    bits sum = (bits)(whole | (h & (whole - 1))) << REST;
    const bits small = (l << 1) && further < 113 ? ((bits)(whole | (l & (whole - 1))) << REST) >> further : 0;
    sum = sign == l >> 63 ? sum + small : sum - small;
    int shift = 0;
    if (sum >> 112 == 0) sum <<= 1, shift = 1; /* below a power of two */
    x[2 * i] = (int64_t)(uint64_t)sum;
    x[2 * i + 1] = (int64_t)(sign << 63 | (uint64_t)(exponent - BIAS + QUAD_BIAS - shift) << 48 |
                             ((uint64_t)(sum >> 64) & 0xffffffffffff));
  }
}

/* Multiplies matrices: left [rows][2][inner], right [inner][2][columns], product [rows][2][columns], the high parts of
 * a row before its low ones. The number of columns is a multiple of the lanes of every vector (COLUMNS of
 * pair_products.f90). Errors are at most some 2^-104 of the sum of the moduli of the terms. */
void kz_pair_product(int64_t rows, int64_t inner, int64_t columns, const double *left, const double *right,
                     double *product) {
  for (int64_t i = 0; i < rows; i++)
    for (int64_t first = 0; first < columns; first += LANES) {
      pair total = {broadcast_value(0), broadcast_value(0)};
      for (int64_t k = 0; k < inner; k++) {
        const double *a = left + 2 * i * inner + k, *b = right + 2 * k * columns + first;
        accumulate_pair(&total, (pair){broadcast_value(a[0]), broadcast_value(a[inner])},
                        (pair){*(const vector *)b, *(const vector *)(b + columns)});
      }
      total = two_sum(total.high, total.low);
      *(vector *)(product + 2 * i * columns + first) = total.high;
      *(vector *)(product + (2 * i + 1) * columns + first) = total.low;
    }
}

KZ_INLINE pair coefficient_at(const double *polynomial, int64_t n, int64_t power, int64_t i) {
  const double *numbers = polynomial + 2 * n * power + i;
  return (pair){*(const vector *)numbers, *(const vector *)(numbers + n)};
}

/* Computes the brackets f_v g_theta - f_theta g_v of polynomials in v at n points, a multiple of the lanes of every
 * vector, up to v^top. Polynomials, slopes (derivatives by theta) and brackets [powers][2][n]: high and low parts. */
void kz_pair_bracket(int64_t n, int64_t top_f, int64_t top_g, int64_t top, const double *f, const double *f_slope,
                     const double *g, const double *g_slope, double *bracket) {
  for (int64_t i = 0; i < n; i += LANES)
    for (int64_t c = 0; c <= top; c++) {
      pair total = {broadcast_value(0), broadcast_value(0)};
      for (int64_t b = c + 1 < top_f ? 0 : c + 1 - top_f; b <= c + 1 && b <= top_g; b++) {
        const int64_t a = c + 1 - b;
        const vector by_v = broadcast_value((double)a), by_w = broadcast_value(-(double)b);
        const pair x = coefficient_at(f, n, a, i), y = coefficient_at(f_slope, n, a, i);
        const pair p = product_unnormalised(x, coefficient_at(g_slope, n, b, i)),
                   q = product_unnormalised(y, coefficient_at(g, n, b, i));
        accumulate_pair(&total, p, (pair){by_v, broadcast_value(0)});
        accumulate_pair(&total, q, (pair){by_w, broadcast_value(0)});
      }
      total = two_sum(total.high, total.low);
      *(vector *)(bracket + 2 * n * c + i) = total.high;
      *(vector *)(bracket + (2 * c + 1) * n + i) = total.low;
    }
}
