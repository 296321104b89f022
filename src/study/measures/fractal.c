/* Measures of how intricate the boundaries in the picture are: entropy (A. Daza et al., Sci. Rep. 6 (2016) 31416),
 * uncertainty exponent and dimension (C. Grebogi et al., Phys. Lett. A 99 (1983) 415), boundaries that basins share (A.
 * Daza et al., Sci. Rep. 8 (2018) 9954). */
#include "kapitza/analysis_boundary.h"
#include "measures.h"

enum { SHARED_BOX = 16 }; /* cells along an edge of a box of shared boundaries */
static const double ALL = 0.99;

static void fractal_entropies(const kz_measured *measured, double *entropy, double *boundary) {
  const int64_t cells = measured->plan->options.cells;
  KZ_AUTOFREE kz_counts *counts = kz_calloc(1, sizeof *counts);
  kz_count_boxes(cells, cells, measured->picture.id, counts);
  kz_entropy_of(counts, entropy, boundary);
}

void kz_measure_entropy(const kz_measured *measured, double *value) {
  double boundary;
  fractal_entropies(measured, value, &boundary);
}

void kz_measure_boundary_entropy(const kz_measured *measured, double *value) {
  double whole;
  fractal_entropies(measured, &whole, value);
}

/* Uncertainty exponent of each basin's boundary, from pairs of cells beside each other along theta. */
void kz_measure_uncertainty_exponent(const kz_measured *measured, double *value) {
  const kz_measures_plan *plan = measured->plan;
  const int64_t cells = plan->options.cells, n = measured->catalogue.count;
  const double across = (plan->theta.max - plan->theta.min) / (double)cells;
  KZ_AUTOFREE int16_t *side = kz_malloc((size_t)(cells * cells) * sizeof *side);
  KZ_AUTOFREE kz_counts *counts = kz_malloc(sizeof *counts);
  for (int64_t id = 0; id < n; id++) {
    kz_uncertain uncertain[KZ_DISTANCES];
    int distances = 0;
    *counts = (kz_counts){0};
    for (int64_t i = 0; i < cells * cells; i++)
      side[i] = measured->picture.id[i] < 0 ? -1 : measured->picture.id[i] == id;
    kz_count_pairs(cells, cells, side, kz_axis_is_circle(&plan->theta), counts);
    for (int d = KZ_DISTANCES - 1; d >= 0; d--)
      if (counts->compared[d] > 0)
        uncertain[distances++] = (kz_uncertain){ldexp(across, d), counts->compared[d], counts->uncertain[d]};
    const kz_slope line = kz_uncertainty_line(distances, uncertain);
    value[id] = line.slope;
    value[n + id] = line.low;
    value[2 * n + id] = line.high;
  }
}

/* 2 minus the exponent. */
void kz_measure_boundary_dimension(const kz_measured *measured, double *value) {
  const int64_t n = measured->catalogue.count;
  kz_measure_uncertainty_exponent(measured, value);
  for (int64_t id = 0; id < n; id++) {
    const double low = value[n + id];
    value[id] = 2 - value[id];
    value[n + id] = 2 - value[2 * n + id];
    value[2 * n + id] = 2 - low;
  }
}

/* Finds which basins the box of a picture that begins at a cell holds: seen [n]. Returns how many. */
static int64_t look_into_box(const kz_measured *measured, int64_t left, int64_t bottom, bool *seen) {
  const int64_t cells = measured->plan->options.cells;
  int64_t basins = 0;
  for (int64_t id = 0; id < measured->catalogue.count; id++) seen[id] = false;
  for (int64_t row = bottom; row < cells && row < bottom + SHARED_BOX; row++)
    for (int64_t column = left; column < cells && column < left + SHARED_BOX; column++) {
      const int16_t id = measured->picture.id[row * cells + column];
      if (id < 0 || seen[id]) continue;
      seen[id] = true;
      basins++;
    }
  return basins;
}

/* Share of the boxes on any boundary that each basin is in. */
void kz_measure_shared_boundary(const kz_measured *measured, double *value) {
  const int64_t cells = measured->plan->options.cells, n = measured->catalogue.count;
  KZ_AUTOFREE bool *seen = kz_malloc((size_t)n * sizeof *seen + 1);
  double boxes = 0;
  for (int64_t id = 0; id < n; id++) value[id] = 0;
  for (int64_t bottom = 0; bottom < cells; bottom += SHARED_BOX)
    for (int64_t left = 0; left < cells; left += SHARED_BOX) {
      if (look_into_box(measured, left, bottom, seen) < 2) continue;
      boxes++;
      for (int64_t id = 0; id < n; id++) value[id] += seen[id];
    }
  for (int64_t id = 0; id < n; id++) value[id] = boxes > 0 ? value[id] / boxes : NAN;
}

/* Whether three or more basins share all of their boundary on the grid: each is in nearly every box of it. */
void kz_measure_wada_on_grid(const kz_measured *measured, double *value) {
  const int64_t n = measured->catalogue.count;
  KZ_AUTOFREE double *share = kz_malloc((size_t)n * sizeof *share + 1);
  int64_t basins = 0, all = 0;
  kz_measure_shared_boundary(measured, share);
  for (int64_t id = 0; id < n; id++) {
    basins += share[id] > 0;
    all += share[id] >= ALL;
  }
  *value = basins > 2 && all == basins;
}
