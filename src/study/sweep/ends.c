/* The value at which a branch ends, to rounding: where the equations of its bifurcation hold (docs/explanation/atlas.md). */
#include <math.h>
#include <string.h>

#include "kapitza/dynamics_curves.h"
#include "sweep.h"

/* A strobe point of a cycle that merges with another one is this near to it, rad; an end lies so near to where a walk stopped, in sizes of
 * the value. */
static const double MERGING = 0.05, NEAR = 1e-6;

/* The values of a path as a plane of one key: a place is the distance from where the walk stopped, in sizes of the value. */
typedef struct {
  const kz_path *path;
  double stopped, size;
} line;

static bool pendulum_at(const void *context, const double place[2], kz_pendulum *pendulum) {
  const line *l = context;
  return l->path->pendulum(l->path->context, l->stopped + place[0] * l->size, pendulum);
}

/* The first `points` points become the means of pairs that are so far apart in time; a mirror image: side -1. */
static bool take_means(double *y, int points, double side) {
  const double lift = 2 * M_PI * rint((y[2 * points] - side * y[0]) / (2 * M_PI));
  if (fabs(y[2 * points] - lift - side * y[0]) > MERGING) return false;
  for (int i = 0; i < points; i++) {
    y[2 * i] = 0.5 * (y[2 * i] + side * (y[2 * (i + points)] - lift));
    y[2 * i + 1] = 0.5 * (y[2 * i + 1] + side * y[2 * (i + points) + 1]);
  }
  return true;
}

/* Rest is solved on the map where a multiplier of it is -1, and on its mirror image where one is 1. */
static kz_curve_kind rest(int end_kind, double *y) {
  const int32_t inverted = cos(y[0]) < 0;
  y[0] = M_PI * inverted, y[1] = 0;
  return end_kind == KZ_END_PERIOD_DOUBLING ? (kz_curve_kind){1, 1, -1, 0} : (kz_curve_kind){-1, 1, -1, inverted};
}

/* The cycle that has the multiplier at the end: the branch's own, or the one that it merges with. y: points of the branch's cycle, then of that
 * one. points = 0: not known. */
static kz_curve_kind cycle_at_end(const kz_branch_point *end, int end_kind, double *y) {
  const int n = end->period, half = n / 2;
  const bool even = n % 2 == 0;
  if (end->symmetric && (n == 1 || (end_kind == KZ_END_PERIOD_DOUBLING && n == 2))) return rest(end_kind, y);
  if (end_kind == KZ_END_SYMMETRY_BREAKING && n == 1) return rest(end_kind, y);
  if (end->symmetric && end_kind == KZ_END_PERIOD_DOUBLING) return (kz_curve_kind){0};
  if (end->symmetric) return (kz_curve_kind){-1, half, end_kind == KZ_END_FOLD ? 1 : -1, 0};
  if (end_kind == KZ_END_SYMMETRY_BREAKING) return (kz_curve_kind){even && take_means(y, half, -1) ? -1 : 0, half, -1, 0};
  if (end_kind == KZ_END_PERIOD_DOUBLING && end->multiplier_re[0] > 0)
    return (kz_curve_kind){even && take_means(y, half, 1), half, -1, 0};
  return (kz_curve_kind){1, n, end_kind == KZ_END_FOLD ? 1 : -1, 0};
}

double kz_locate_end(const kz_path *path, double stopped, const kz_branch_point *end, int end_kind) {
  const line l = {path, stopped, fmax(fabs(stopped), 1e-3)};
  const double here[2] = {0, 0}, along[2] = {1, 0};
  double y[2 * KZ_CURVE_POINTS + 4] = {end->theta, end->velocity}, next[4];
  kz_pendulum pendulum;
  kz_numerics fine;
  if (end_kind == KZ_END_NOT_LOCATED || end_kind == KZ_END_NEIMARK_SACKER || end->period > KZ_CURVE_POINTS ||
      !pendulum_at(&l, here, &pendulum))
    return stopped;
  kz_numerics_fine(&pendulum, &fine);
  const kz_plane plane = {.pendulum = pendulum_at,
                          .context = &l,
                          .low = {-1, -1},
                          .high = {1, 1},
                          .steps = 2 * fine.steps_per_period, /* Newton's method takes half of them */
                          .mirrored = kz_is_mirrored(&pendulum)};
  if (!kz_curve_orbit(&plane, here, end->period, y)) return stopped;
  kz_curve_kind kind = cycle_at_end(end, end_kind, y);
  if (kind.side == 0) return stopped;
  const int n = 2 * kind.points;
  next[0] = y[n - 2], next[1] = y[n - 1];
  if (!kz_curve_orbit(&plane, here, 1, next)) return stopped;
  kind.turns = (int32_t)rint((next[2] - kind.side * y[0]) / (2 * M_PI));
  memcpy(y + n, here, sizeof here);
  if (!kz_curve_locate(&plane, &kind, y, along) || fabs(y[n]) > NEAR) return stopped;
  return stopped + y[n] * l.size;
}
