/* Products of matrices in pairs of doubles: pair_products.f90. */
#include "vector/pairs_arithmetic.h"

/* product = left right: left [rows][inner][2], high and low of each number; right [inner][2][columns] and product [rows][2][columns], the high
 * parts of a row before its low ones. The number of columns is a multiple of the lanes of every vector (COLUMNS of pair_products.f90). The error
 * of a number is at most some 2^-104 of the sum of the moduli of its terms. */
void kz_pair_product(int64_t rows, int64_t inner, int64_t columns, const double *left, const double *right, double *product) {
  for (int64_t i = 0; i < rows; i++)
    for (int64_t first = 0; first < columns; first += LANES) {
      pair total = {same(0), same(0)};
      for (int64_t k = 0; k < inner; k++) {
        const double *a = left + 2 * (i * inner + k), *b = right + 2 * k * columns + first;
        gain(&total, (pair){same(a[0]), same(a[1])}, (pair){*(const vector *)b, *(const vector *)(b + columns)});
      }
      total = quick_sum(total.high, total.low);
      *(vector *)(product + 2 * i * columns + first) = total.high;
      *(vector *)(product + (2 * i + 1) * columns + first) = total.low;
    }
}
