/* Seeds of other curves, from known ones. */
#pragma once

#include "types.h"

/* From the first curve that a cycle meets along the vertical axis, else along the other one; from a curve's degenerate
 * points, its images and, if `middle`, its middle along both axes; along the line where the other coordinate than
 * `axis` is `value`, from all crossings of curves `first` and later. Not NULL: the branches join `drawn`. */
void kz_atlas_explore_first(const kz_atlas *atlas, const kz_cycle *cycle, kz_atlas_seeds *seeds);
void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, bool middle, kz_atlas_seeds *seeds);
void kz_atlas_explore_line(kz_atlas *atlas, int axis, double value, int64_t first, kz_atlas_seeds *seeds,
                           kz_atlas_branches *drawn);
/* The point of a curve at a crossing of the line where the other coordinate than `axis` is `value`. */
bool kz_atlas_crossing_point(const kz_atlas *atlas, int axis, double value, const kz_atlas_crossing *crossing,
                             kz_cycle *at);
/* Daughter cycle beside a point of a curve with multiplier -1, and the direction along the axis where it exists. */
bool kz_atlas_grown(const kz_atlas *atlas, const kz_cycle *flip, int axis, kz_cycle *child, double along[2]);
/* Half a drive period later, with angles from upside down, a motion at k is a motion at -k. On a plane with k and -k
 * the image of a curve's point `at` becomes a seed. */
void kz_atlas_explore_image(const kz_atlas *atlas, const kz_cycle *at, kz_atlas_seeds *seeds);
/* The curve that Newton's method finds from the mirror image of a curve's point becomes a seed: another one where the
 * symmetry is broken. */
void kz_atlas_explore_mirrored(const kz_atlas *atlas, const kz_cycle *at, kz_atlas_seeds *seeds);
/* Compares lines at values of k with those at -k; what has no partner there becomes a seed. */
void kz_atlas_compare_images(kz_atlas *atlas);
