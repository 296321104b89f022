/* Relatives of cycles over a plane: the cycle that one merges with at its end, and its daughters. */
#pragma once

#include "kapitza/dynamics_curves.h"

/* A kind of cycle; rest: -1, or 0 for rest down and 1 for rest inverted. */
typedef struct {
  kz_curve_kind of;
  int32_t rest;
} kz_cycle_kind;
/* A cycle, or a point of a curve, and its place. */
typedef struct {
  kz_cycle_kind kind;
  double y[2 * KZ_CURVE_POINTS + 2];
} kz_plane_cycle;

/* Drive periods of a cycle of this kind. */
int32_t kz_kind_period(const kz_cycle_kind *kind);

/* Determinant of the derivative of the map of which a cycle is a fixed point. */
double kz_kind_determinant(const kz_curve_kind *kind, double beta);

/* The kind of a cycle on a curve, with the turns that it takes: y [points][2] and its place, its points `stride`
 * periods apart. side -1: its last point is carried to the image of the first. points = 0 where it cannot be carried.
 */
kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int stride, int multiplier, const double *y);

/* Finds the cycle with which a cycle near its end merges at an event of its branch (KZ_EVENT_HALVES, _MIRROR or _REST):
 * that cycle, with the multiplier -1 of its own map, to `parent`. False where there is none. */
bool kz_parent_of(const kz_plane *plane, kz_event event, const kz_plane_cycle *cycle, kz_plane_cycle *parent);

/* Kind that the cycle of a curve with multiplier -1 turns into. */
kz_cycle_kind kz_child_kind(const kz_cycle_kind *kind);
/* Along an axis on which the number of a curve changes less than this nothing branches off. */
#define KZ_CHILD_FLAT 1e-12
/* Finds the branch at the point `flip` of such a curve: its cycle a little beside, and the direction along the axis in
 * which it exists. False if nothing does. */
bool kz_child_of(const kz_plane *plane, const kz_plane_cycle *flip, int axis, kz_plane_cycle *child, double along[2]);
