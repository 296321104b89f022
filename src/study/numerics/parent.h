/* Relatives of cycles over a plane: the cycle that one merges with at its end, and its daughters. */
#pragma once

#include "kapitza/dynamics_curves.h"

/* Drive periods of a cycle of this kind. */
int32_t kz_kind_period(const kz_cycle_kind *kind);
/* Determinant of the derivative of the map of which a cycle is a fixed point. */
double kz_kind_determinant(const kz_cycle_kind *kind, double beta);
/* Angle of a kind of rest, rad. */
static inline double kz_kind_rest(const kz_cycle_kind *kind) {
  return kind->rest == 2 ? M_PI : 0;
}

/* Sets the turns that a cycle takes, and `half`, from its last point, whose image is the first one, or with side -1 the
 * image of that. False, and turns 0, where it cannot be carried. */
bool kz_cycle_close(const kz_plane *plane, kz_cycle *cycle);

/* Finds the cycle with which a cycle near its end merges at an event of its branch (KZ_EVENT_HALVES, _MIRROR or _REST):
 * that cycle, with the multiplier -1 of its own map, to `parent`. False where there is none. */
bool kz_cycle_parent(const kz_plane *plane, const kz_cycle *event, kz_cycle *parent);

/* Kind that the cycle of a curve with multiplier -1 turns into. */
kz_cycle_kind kz_child_kind(const kz_cycle_kind *kind);
/* Along an axis on which the number of a curve changes less than this nothing branches off. */
#define KZ_CHILD_FLAT 1e-12
/* Finds the branch at the point `flip` of such a curve: its cycle a little beside, and the direction along the axis in
 * which it exists. False if nothing does. */
bool kz_cycle_child(const kz_plane *plane, const kz_cycle *flip, int axis, kz_cycle *child, double along[2]);
