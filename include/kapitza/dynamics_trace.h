/* dynamics, curves: traces over a plane where cycles are born, lose stability or symmetry (Fortran; layer 1). */
#pragma once

#include "kapitza/dynamics_curves.h"

/* Follows the curve through `seed` to both ends of a direction (1 or -1), in steps of at most `longest`. rows [most][8
 * + 2 points]: place, tangent's part of the place, normal form, its side (a gradient by the place), distance from the
 * nearest parent (rad), points of the cycle; places are right to about 1e-12. special [most_special][3 + 2 points]:
 * zeros of the normal form: 1 cusp or 2 degenerate flip or symmetry breaking, place, points. Returns the number of
 * rows.
 *
 * Normal form: multiplier 1: half the second derivative along the eigenvector; a pair of cycles exists on the side.
 * Multiplier -1: the cubic coefficient; the cycle attracts on the side; > 0: beyond the curve its child attracts. */
int64_t kz_curve_trace(const kz_plane *plane, const kz_curve_kind *kind, const double *seed, int32_t explore_direction,
                       double longest, int64_t most, double *rows, int64_t most_special, double *special,
                       int64_t *n_special, int32_t *ending);

/* Whether the cycle near y has the kind's multiplier at the place of y; y becomes that cycle. 1 = yes, else 0. */
int32_t kz_curve_is_on(const kz_plane *plane, const kz_curve_kind *kind, double *y);
