/* Boundaries of basins in numbers: uncertain pairs, and boxes that hold several labels. */
#include "kapitza/analysis.h"
#include "kapitza/analysis_boundary.h"

static const double NORMAL = 1.959963984540054; /* Quantile of a 95 % interval */

static kz_slope slope_between(const kz_uncertain *far, const kz_uncertain *near) {
  kz_slope s = {far->distance, near->distance, NAN, NAN, NAN};
  const double decades = log(far->distance / near->distance);
  if (far->uncertain == 0 || near->pairs == 0 || far->pairs == 0) return s;
  const double far_share = (double)far->uncertain / (double)far->pairs;
  /* With no uncertain pair the share is below 3 / pairs with 95 % confidence, and only the lower end is known. */
  if (near->uncertain == 0) {
    s.low = log(far_share * (double)near->pairs / 3) / decades;
    s.high = INFINITY;
    return s;
  }
  const double near_share = (double)near->uncertain / (double)near->pairs;
  const double error =
      NORMAL / decades * sqrt((1 - far_share) / (double)far->uncertain + (1 - near_share) / (double)near->uncertain);
  s.slope = log(far_share / near_share) / decades;
  s.low = s.slope - error;
  s.high = s.slope + error;
  return s;
}

kz_slope kz_uncertainty_slopes(int64_t n, const kz_uncertain *uncertain, kz_slope *slope) {
  int64_t nearest = 0;
  for (int64_t i = 0; i + 1 < n; i++) slope[i] = slope_between(uncertain + i, uncertain + i + 1);
  for (int64_t i = 0; i < n; i++)
    if (uncertain[i].uncertain >= KZ_ENOUGH_UNCERTAIN) nearest = i;
  if (nearest == 0) return (kz_slope){NAN, NAN, NAN, NAN, NAN};
  return slope_between(uncertain, uncertain + nearest);
}

kz_slope kz_uncertainty_line(int64_t n, const kz_uncertain *uncertain) {
  kz_slope line = {NAN, NAN, NAN, NAN, NAN};
  double points = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0, noise = 0;
  for (int pass = 0; pass < 2; pass++)
    for (int64_t i = 0; i < n; i++) {
      const double hits = (double)uncertain[i].uncertain, share = hits / (double)uncertain[i].pairs;
      if (hits < KZ_ENOUGH_UNCERTAIN) continue;
      if (pass == 0) {
        if (points++ == 0) line.far = uncertain[i].distance;
        line.near = uncertain[i].distance;
        mean_x += (log(uncertain[i].distance) - mean_x) / points;
        mean_y += (log(share) - mean_y) / points;
        continue;
      }
      const double x = log(uncertain[i].distance) - mean_x, y = log(share) - mean_y;
      xx += x * x;
      xy += x * y;
      yy += y * y;
      noise += x * x * (1 - share) / hits;
    }
  if (points < 2) return (kz_slope){NAN, NAN, NAN, NAN, NAN};
  line.slope = xy / xx;
  const double scatter = points > 2 ? fmax(0, yy - line.slope * xy) / (points - 2) / xx : 0;
  const double error = NORMAL * sqrt(fmax(noise / (xx * xx), scatter));
  line.low = line.slope - error;
  line.high = line.slope + error;
  return line;
}

static uint64_t bit_of(int16_t label) {
  return label < 0 ? 0 : (uint64_t)1 << (label < KZ_BOX_LABELS - 1 ? label : KZ_BOX_LABELS - 1);
}

static void count_boxes(int64_t n, const uint64_t *held, int size, kz_box_counts *counts) {
  for (int64_t i = 0; i < n; i++) {
    uint64_t mask = held[i];
    if ((mask & (mask - 1)) == 0) continue; /* one label at most */
    counts->boxes[size]++;
    for (int label = 0; mask != 0; label++, mask >>= 1) counts->with[size][label] += (int64_t)(mask & 1);
  }
}

int kz_box_sizes(int64_t columns, int64_t rows) {
  int sizes = 0;
  while (sizes < KZ_BOX_SIZES && (int64_t)1 << sizes <= columns && (int64_t)1 << sizes <= rows) sizes++;
  return sizes;
}

void kz_boxes_count(int64_t columns, int64_t rows, const int16_t *label, int sizes, kz_box_counts *counts) {
  int64_t across = columns - 1, up = rows - 1;
  if (across < 1 || up < 1) return;
  KZ_AUTOFREE uint64_t *held = kz_malloc((size_t)(across * up) * sizeof *held);
  for (int64_t r = 0; r < up; r++)
    for (int64_t c = 0; c < across; c++) {
      const int16_t *corner = label + r * columns + c;
      held[r * across + c] =
          bit_of(corner[0]) | bit_of(corner[1]) | bit_of(corner[columns]) | bit_of(corner[columns + 1]);
    }
  for (int size = 0; size < sizes; size++) {
    count_boxes(across * up, held, size, counts);
    const int64_t half_across = (across + 1) / 2, half_up = (up + 1) / 2;
    for (int64_t r = 0; r < half_up; r++)
      for (int64_t c = 0; c < half_across; c++) {
        const int64_t right = 2 * c + 1 < across, above = 2 * r + 1 < up ? across : 0;
        const uint64_t *corner = held + 2 * r * across + 2 * c;
        held[r * half_across + c] = corner[0] | corner[right] | corner[above] | corner[above + right];
      }
    across = half_across;
    up = half_up;
  }
}

double kz_boxes_dimension(const kz_box_counts *counts, int size) {
  if (counts->boxes[size] == 0 || counts->boxes[size + 1] == 0) return NAN;
  return log2((double)counts->boxes[size] / (double)counts->boxes[size + 1]);
}
