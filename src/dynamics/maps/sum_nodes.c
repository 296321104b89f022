/* Sums of Lagrange's interpolation over nodes of the map table. In C: gfortran turns each row of nodes round. */
#include <stdint.h>

#if !defined KAPITZA_FUSED || KAPITZA_FUSED != 1
#error "map tables are interpolated by fused operations: -ffp-contract=fast (cmake/Compilers.cmake)"
#endif

enum { MOST = 6 }; /* nodes of a stencil along an axis */

/* Both displacements of one node, and of two beside each other. */
typedef double node __attribute__((vector_size(16), aligned(8), may_alias));
typedef double nodes __attribute__((vector_size(32), aligned(8), may_alias));

/* kz_sum_nodes of one lane. Callers pass a constant `points`: loops are unrolled, sums stay in registers. */
static inline __attribute__((always_inline)) node sum_of(int points, int64_t length, const double *field, int64_t width,
                                                         const double *wu, const double *wv) {
  union {
    nodes pairs[MOST / 2];
    node single[MOST];
  } row;
  for (int c = 0; c < points / 2; c++) row.pairs[c] = (nodes){0};
  for (int b = 0; b < points; b++, field += length)
    for (int c = 0; c < points / 2; c++) row.pairs[c] += wv[b * width] * *(const nodes *)(field + 4 * c);
  node sum = {0};
  for (int a = 0; a < points; a++) sum += wu[a * width] * row.single[a];
  return sum;
}

/* shift [n][2] = the displacements interpolated over points x points nodes (2 or 6) around the cells (i, j), from 0.
 * field: from node (0, 0) on; a velocity has `length` doubles. wu, wv [points][width]: weights of the nodes of each
 * lane. */
void kz_sum_nodes(int32_t points, int32_t n, int64_t length, const double *field, const int32_t *i, const int32_t *j,
                  int64_t width, const double *wu, const double *wv, double *shift) {
  const double *corner = field + (1 - points / 2) * (length + 2);
  for (int32_t lane = 0; lane < n; lane++) {
    const double *first = corner + j[lane] * length + 2 * (int64_t)i[lane];
    *(node *)(shift + 2 * lane) = points == 2 ? sum_of(2, length, first, width, wu + lane, wv + lane)
                                              : sum_of(MOST, length, first, width, wu + lane, wv + lane);
  }
}
