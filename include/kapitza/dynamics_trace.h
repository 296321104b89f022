/* dynamics, curves: traces over a plane where cycles are born, lose stability or symmetry (Fortran; layer 1). */
#pragma once

#include "kapitza/dynamics_curves.h"

/* A point of a curve, right to about 1e-12 with its place; the tangent's part of the place. */
typedef struct {
  kz_cycle at;
  double tangent[2];
  kz_normal_form form;
} kz_curve_row;
/* Follows the curve through `seed` to one end: rows [most]; special [most_events]: zeros of the normal form, which are
 * cusps, or with the multiplier -1 degenerate flips and symmetry breakings. */
void kz_curve_trace(const kz_plane *plane, const kz_cycle *seed, const kz_branch_way *way, kz_curve_row *rows,
                    kz_cycle *special, kz_branch_end *end);

/* Whether the cycle near this one has its kind's multiplier at its place; it becomes that cycle. 1 = yes, else 0. */
int32_t kz_cycle_is_on(const kz_plane *plane, kz_cycle *cycle);
