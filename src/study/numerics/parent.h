/* The cycle that another one merges with where it ends. */
#pragma once

#include "kapitza/dynamics_curves.h"

/* The kind of a cycle on a curve, with the turns that it takes: y [points][2] and its place, its points `stride` periods apart. side -1: its last
 * point is carried to the mirror image of the first. points = 0 where it cannot be carried. */
kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int stride, int multiplier, const double *y);

/* What a cycle of the kind `of` near its end merges with: KZ_EVENT_HALVES, _MIRROR or _REST, and the kind of that cycle where it has the multiplier
 * -1 of its own map. cycle [points][2] and its place; near: rad, how far its points may lie from those of the other one. Writes points and place of
 * that one to `parent`. points = 0 where there is none. */
kz_curve_kind kz_parent_of(const kz_plane *plane, int event, const kz_curve_kind *of, const double *cycle, double near,
                           double *parent);

/* What the cycle of a curve with multiplier -1 turns into. rest: 0 or 1 if it is rest down or inverted, else -1. */
kz_curve_kind kz_child_kind(const kz_curve_kind *kind, int rest);
/* Along an axis on which the number of a curve changes less than this nothing branches off. */
#define KZ_CHILD_FLAT 1e-12
/* What branches off the point `flip` of such a curve: its cycle a little beside, to `child`, and the direction along the axis in which it exists. False
 * if nothing does. */
bool kz_child_of(const kz_plane *plane, const kz_curve_kind *kind, int rest, const double *flip, int axis, double *child,
                 double along[2]);
