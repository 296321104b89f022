/* Crossings of curves along a line, bands beside curves, and counts of attractors. */
#pragma once

#include "types.h"

/* The crossings of the line where coordinate `axis` is `value`, in order of the other coordinate; with the classes that
 * change, or one for each curve alone. */
void kz_atlas_crossings_of(kz_atlas *atlas, int axis, double value, bool classes, kz_atlas_crossings *crossings);
/* The width of the band of attractors at a point of a curve with this normal form, in sides of the plane, if it is
 * narrow: along the direction in which the gradient of the form's side was taken. d: determinant of the cycle's map. */
double kz_atlas_band(const kz_cycle_kind *kind, double d, double form, double gradient);
/* The width at a point of a curve, across it. */
double kz_atlas_band_at(const kz_atlas *atlas, const kz_cycle *at);
/* The widest band of attractors beside a curve within the plane, across the curve; 1 at most. */
double kz_atlas_widest(const kz_atlas *atlas, const kz_atlas_curve *curve);
/* Takes edges of narrow bands that lack the other edge out of the crossings of a line. */
void kz_atlas_pair(kz_atlas_crossings *crossings);
/* The order of crossings along a line, for qsort. */
int kz_atlas_compare_crossings(const void *first, const void *second);
/* counts [KZ_ATLAS_MOST_CLASSES] of attractors at the start of a column, y = kz_atlas_floor; at any place. */
double kz_atlas_floor(const kz_atlas *atlas);
/* Column in which x is counted: beside x where k = 0 and an undriven edge meet, as curves of rest turn there. */
double kz_atlas_column(const kz_atlas *atlas, double x);
void kz_atlas_base(kz_atlas *atlas, double x, int32_t *counts);
void kz_atlas_count(kz_atlas *atlas, const double place[2], int32_t *counts);
/* Whether counts may be right: none is negative. */
bool kz_atlas_plausible(const kz_atlas *atlas, const int32_t *counts);
/* Adds to counts what changes between two values along a line. */
void kz_atlas_changes(const kz_atlas_crossings *crossings, double from, double to, int32_t *counts);
void kz_atlas_crossings_free(kz_atlas_crossings *crossings);
