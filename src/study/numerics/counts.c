#include "counts.h"

/* One box of across x up cells: its settled cells, and how many of them each label has. */
static void count_box(int64_t columns, int64_t across, int64_t up, const int16_t *label, kz_counts *counts) {
  int16_t seen[KZ_BOX_CELLS];
  int of[KZ_BOX_CELLS], n = 0, settled = 0;
  for (int64_t cell = 0; cell < across * up; cell++) {
    const int16_t own = label[cell / across * columns + cell % across];
    int k = 0;
    if (own < 0) continue;
    while (k < n && seen[k] != own) k++;
    if (k == n) {
      seen[n] = own;
      of[n++] = 0;
    }
    of[k]++;
    settled++;
  }
  if (settled == 0) return;
  counts->boxes[settled]++;
  for (int k = 0; k < n; k++) counts->parts[settled][of[k]]++;
}

static int64_t side_of(int64_t cells) {
  return kz_smaller(cells, KZ_BOX);
}

void kz_count_boxes(int64_t columns, int64_t rows, const int16_t *label, kz_counts *counts) {
  for (int64_t row = 0; row < rows; row += KZ_BOX)
    for (int64_t column = 0; column < columns; column += KZ_BOX)
      count_box(columns, side_of(columns - column), side_of(rows - row), label + row * columns + column, counts);
}

/* n cells beside those to their left and right. */
static void counts_compare(int64_t n, const int16_t *label, const int16_t *left, const int16_t *right,
                           int64_t *compared, int64_t *uncertain) {
  int32_t known = 0, differ = 0;
  for (int64_t i = 0; i < n; i++) { /* over vectors: without a branch */
    const int16_t settled = (int16_t)(label[i] | left[i] | right[i]) >= 0;
    known += settled;
    differ += settled & ((left[i] != label[i]) | (right[i] != label[i]));
  }
  *compared += known;
  *uncertain += differ;
}

void kz_count_pairs(int64_t columns, int64_t rows, const int16_t *label, bool circle, kz_counts *counts) {
  for (int d = 0; d < KZ_DISTANCES && ((int64_t)16 << d) <= columns; d++) {
    const int64_t away = (int64_t)1 << d, inner = columns - 2 * away, last = columns - away;
    int64_t *compared = &counts->compared[d], *uncertain = &counts->uncertain[d];
    for (const int16_t *row = label; row < label + rows * columns; row += columns) {
      counts_compare(inner, row + away, row, row + 2 * away, compared, uncertain);
      if (!circle) continue;
      counts_compare(away, row, row + last, row + away, compared, uncertain);
      counts_compare(away, row + last, row + last - away, row, compared, uncertain);
    }
  }
}

void kz_entropy_of(const kz_counts *counts, double *entropy, double *boundary_entropy) {
  double total = 0;
  int64_t boxes = 0, mixed = 0;
  for (int settled = 1; settled <= KZ_BOX_CELLS; settled++) {
    boxes += counts->boxes[settled];
    mixed += counts->boxes[settled] - counts->parts[settled][settled];
    for (int part = 1; part < settled; part++) {
      const double share = (double)part / settled;
      total -= (double)counts->parts[settled][part] * share * log(share);
    }
  }
  *entropy = boxes > 0 ? total / (double)boxes : 0;
  *boundary_entropy = mixed > 0 ? total / (double)mixed : 0;
}

double kz_uncertain_share(const kz_counts *counts, int d) {
  return counts->compared[d] > 0 ? (double)counts->uncertain[d] / (double)counts->compared[d] : 0;
}
