/* Lines of an atlas from a file: places of values, multipliers, branches along an axis. */
#pragma once

#include "types.h"

/* The place of a value along an axis of the file, to that of the search. KZ_REFUSED outside of the plane. */
kz_status kz_atlas_place(const kz_atlas *atlas, int axis, double value, double *place);
/* Multipliers of the whole period of a cycle from trace and determinant of its own map. */
void kz_atlas_multipliers(const kz_cycle *cycle, double re[2], double im[2]);
/* Adds a branch, as kz_cycle_continue gives it, to a line along an axis, with a point where it gains or loses its
 * stability, an event. */
void kz_atlas_draw(const kz_atlas *atlas, int axis, const kz_cycle *row, const kz_cycle *event,
                   const kz_branch_end *end, kz_atlas_branches *line);
