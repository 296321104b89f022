/* The cycle that another one merges with where it ends. */
#ifndef KAPITZA_STUDY_PARENT_H
#define KAPITZA_STUDY_PARENT_H

#include "kapitza/dynamics_curves.h"

/* The kind of a cycle on a curve, with the turns that it takes: y [points][2] and its place. side -1: its last point is carried to the mirror image
 * of the first. points = 0 where it cannot be carried. */
kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int multiplier, const double *y);

/* What a cycle of n periods near its end merges with: KZ_EVENT_HALVES, _MIRROR or _REST, and the kind of that cycle where it has the multiplier -1
 * of its own map. cycle [n][2] and its place; near: rad, how far its points may lie from those of the other one. Writes points and place of that one to
 * `parent`. points = 0 where there is none. */
kz_curve_kind kz_parent_of(const kz_plane *plane, int event, int n, const double *cycle, double near, double *parent);

#endif
