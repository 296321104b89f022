/* dynamics, curves: cycles over a plane of two parameters, attracting or not: branches of them along lines, and the
 * curves on which they are born, lose their stability or their symmetry (Fortran; layer 1). docs/explanation/atlas.md
 * has the equations.
 *
 * A place is a pair of numbers, each in units of a side of the rectangle. Nothing here is collective. */
#pragma once

#include "kapitza/model.h"

/* Gives the pendulum of a place; false if there is none. */
typedef bool (*kz_plane_fn)(const void *context, const double place[2], kz_pendulum *pendulum);
typedef struct {
  kz_plane_fn pendulum;
  const void *context;
  double low[2], high[2]; /* curves and branches end beyond them */
  int32_t steps;          /* steps of split6 a period, even; half as many on the way */
  int32_t mirrored;       /* 1 if all pendulums have mirror symmetry, else 0 */
  int32_t half_period;    /* 1 if not, but with a motion theta(t) all have -theta(t + pi), else 0 */
} kz_plane;

/* A kind of cycle: F(x(i)) = x(i+1), side (F(x(n)) - 2 pi turns) = x(1). side 1: cycles of `points` periods with so
 * many net turns; side -1: symmetric cycles of twice as many periods, about down (turns 0) or inverted (1). multiplier:
 * of a point of a curve, 1 or -1, of this map; else 0. stride: drive periods between two points where cycles have more
 * periods than points, so that F is its power; 0 = 1. half 1, of side -1: the last F ends half a period before, so that
 * the cycles have one period less and are their own images under (theta, v, t) -> (-theta, -v, t + pi). rest: 1 = rest
 * down, 2 = rest inverted, 0 = another cycle. */
enum { KZ_CURVE_POINTS = 16 };
typedef struct {
  int32_t side, points, multiplier, turns, stride, half, rest;
} kz_cycle_kind;

/* Events of a branch: a multiplier of its map is 1 or -1; or it ends at the cycle of half its period, its image,
 * rest. */
typedef enum { KZ_EVENT_NONE, KZ_EVENT_FOLD, KZ_EVENT_FLIP, KZ_EVENT_HALVES, KZ_EVENT_MIRROR, KZ_EVENT_REST } kz_event;
/* A cycle, attracting or not, of a branch or a curve: its place and its points in the order of time, rad, not wrapped,
 * and rad per drive radian; 0 behind them. number: trace and determinant of the derivative of its map. */
typedef struct {
  kz_cycle_kind kind;
  kz_event event;
  double place[2], point[KZ_CURVE_POINTS][2], number[2];
} kz_cycle;

/* Ends of branches and curves: outside of the plane, at its own start, at its longest, where a cycle meets its parent
 * (at a degenerate flip or symmetry breaking), where no step is short enough, without a start, where the band of
 * attractors beside it is narrower than 1e-10 sides of the plane. */
typedef enum {
  KZ_TRACE_LEFT,
  KZ_TRACE_CLOSED,
  KZ_TRACE_LONG,
  KZ_TRACE_MERGED,
  KZ_TRACE_STUCK,
  KZ_TRACE_NO_SEED,
  KZ_TRACE_THIN
} kz_trace_ending;

/* How a branch or curve is followed: first in the direction `along` (a unit vector) of a branch, and with a side of 1
 * or -1 along one of the two branches of the fold at its start; a curve in the direction `side`. In steps of at most
 * `longest`, the first of `step`, 0 = short; up to so many rows, and events, if these are not 0. */
typedef struct {
  double along[2], longest, step;
  int64_t most, most_events;
  int32_t side;
} kz_branch_way;
/* Where it ends: after so many rows and events, with the step that would follow. */
typedef struct {
  int64_t rows, events;
  double step;
  kz_trace_ending ending;
} kz_branch_end;
/* Follows the cycle near `start`, attracting or not, through folds: rows [most], events [most_events]. */
void kz_cycle_continue(const kz_plane *plane, const kz_cycle *start, const kz_branch_way *way, kz_cycle *rows,
                       kz_cycle *events, kz_branch_end *end);

/* Newton's method at the cycle's place; 1 if it converges, else 0, and the cycle stays. */
int32_t kz_cycle_solve(const kz_plane *plane, kz_cycle *cycle);
/* Moves it along a line to where its kind's multiplier is that of the curve. 1 if Newton's method converges, else 0. */
int32_t kz_cycle_locate(const kz_plane *plane, kz_cycle *cycle, const double along[2]);
/* Normal form at a point of a curve. Multiplier 1: half the second derivative along the eigenvector; a pair of cycles
 * exists on the side, a gradient by the place. Multiplier -1: the cubic coefficient; the cycle attracts on the side; >
 * 0: beyond the curve its child attracts. vector: the eigenvector at the first point. */
typedef struct {
  double coefficient, side[2], vector[2];
} kz_normal_form;
/* Returns 0 if there is no pendulum. */
int32_t kz_cycle_form(const kz_plane *plane, const kz_cycle *cycle, kz_normal_form *form);
/* Strobe points state [n + 1][2] after state [0], not wrapped (halves 2), or the state at t = pi (halves 1, n = 1).
 * Returns 0 if there is no pendulum. */
int32_t kz_curve_orbit(const kz_plane *plane, const double place[2], int32_t halves, int64_t n, double *state);
