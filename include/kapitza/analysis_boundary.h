/* Boundaries of basins in numbers: uncertainty exponents, box counts. */
#pragma once

#include <stdint.h>

/* Pairs of starts at one distance, and the number of them that end differently (uncertain). */
typedef struct {
  double distance; /* Distance of the pair, rad */
  int64_t pairs, uncertain;
} kz_uncertain;

/* The slope of ln(uncertain share) over ln(distance) between two distances. This is the uncertainty exponent of C.
 * Grebogi, S. W. McDonald, E. Ott, J. A. Yorke, Phys. Lett. 99A (1983) 415: 2 minus the dimension of the boundary. */
typedef struct {
  double far, near;        /* Distances, rad */
  double slope, low, high; /* Slope, 95 % interval; NaN = not known; high is infinite if no nearer pair was uncertain */
} kz_slope;

enum { KZ_ENOUGH_UNCERTAIN = 30 };
/* slope [n - 1] = slopes between neighbours of n falling distances. Returns the slope between the first distance and
 * the last one with KZ_ENOUGH_UNCERTAIN uncertain pairs. The intervals are conservative if pairs share starts. */
kz_slope kz_uncertainty_slopes(int64_t n, const kz_uncertain *uncertain, kz_slope *slope);
/* Returns the slope of the line of least squares through all of the n falling distances that have KZ_ENOUGH_UNCERTAIN
 * uncertain pairs. The interval is that of the scatter about the line or that of the shares, whichever is wider. */
kz_slope kz_uncertainty_line(int64_t n, const kz_uncertain *uncertain);

enum { KZ_BOX_SIZES = 8, KZ_BOX_LABELS = 64 };
/* Boxes of 2^size cells an axis, edges included; those at the last column and row of the grid hold what is left of it.
 * boxes [size] = number of boxes with more than one label; with [size][label] = number of those that contain this label
 * (labels from 63 on count together). The latter are the boundary of this basin when all others are merged (A. Daza, A.
 * Wagemakers, M. A. F. Sanjuan, Sci. Rep. 8 (2018) 9954). */
typedef struct {
  int64_t boxes[KZ_BOX_SIZES];
  int64_t with[KZ_BOX_SIZES][KZ_BOX_LABELS];
} kz_box_counts;
/* Returns the number of sizes whose boxes are no larger than a grid. */
int kz_box_sizes(int64_t columns, int64_t rows);
/* Adds the boxes of the first `sizes` sizes of label [rows][columns] (-1 = none) to *counts. Strips of a grid add up to
 * the whole grid if each begins with the last row of the one before and has 2^(KZ_BOX_SIZES - 1) rows more. */
void kz_boxes_count(int64_t columns, int64_t rows, const int16_t *label, int sizes, kz_box_counts *counts);
/* Returns the box-counting dimension between this size and the next, log2 of the ratio of their boxes. */
double kz_boxes_dimension(const kz_box_counts *counts, int size);
