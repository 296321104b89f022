/* Curves of the atlas: traced, kept once, joined. */
#pragma once

#include "types.h"

/* Traces the curve of a seed to both ends; n = 0 if there is none. */
void kz_atlas_trace(const kz_atlas *atlas, const kz_cycle *seed, kz_atlas_curve *curve);
/* Sets all points of a row from the first one, which a file has alone. */
void kz_atlas_complete(const kz_atlas *atlas, kz_cycle *row);
/* The cycle at a share of the step from a row, between those of both rows, with the place of the row. */
kz_cycle kz_atlas_between(const kz_curve_row *row, double share);
/* The curve of its kind on which a point lies; -1 = none. */
int64_t kz_atlas_known(const kz_atlas *atlas, const kz_cycle *seed);
/* Adds a curve unless most of it lies on a known one; takes its arrays. */
bool kz_atlas_keep(kz_atlas *atlas, kz_atlas_curve *curve);
void kz_atlas_curve_free(kz_atlas_curve *curve);
/* Sets the signature of each of its points. */
void kz_atlas_sign(const kz_atlas *atlas, kz_atlas_curve *curve);
/* Joins ends of folds to the degenerate points that they run into. */
void kz_atlas_join(kz_atlas *atlas);
/* How many ends of a curve lie within the plane without a reason: it is not whole. */
int kz_atlas_open_ends(const kz_atlas_curve *curve);
