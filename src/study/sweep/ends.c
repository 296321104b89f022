/* The value at which a branch ends, to rounding: where the equations of its bifurcation hold (docs/explanation/atlas.md). */
#include <math.h>
#include <string.h>

#include "numerics/parent.h"
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

/* The cycle that has the multiplier at the end: the branch's own, whose points are in y, or the one that it merges with, which y has then.
 * points = 0: not known. */
static kz_curve_kind cycle_at_end(const kz_plane *plane, const kz_branch_point *end, int end_kind, double *y) {
  const int n = end->period, half = n / 2, multiplier = end_kind == KZ_END_FOLD ? 1 : -1;
  const bool doubles = end_kind == KZ_END_PERIOD_DOUBLING, is_flutter = end->symmetric && doubles && n == 2;
  double cycle[2 * KZ_CURVE_POINTS + 4];
  int event = 0;
  if (end->symmetric && (n == 1 || is_flutter))
    event = doubles ? KZ_EVENT_REST : KZ_EVENT_MIRROR;
  else if (end_kind == KZ_END_SYMMETRY_BREAKING && !end->symmetric)
    event = KZ_EVENT_MIRROR;
  else if (doubles && !end->symmetric && end->multiplier_re[0] > 0)
    event = KZ_EVENT_HALVES;
  else if (end->symmetric && doubles)
    return (kz_curve_kind){0};
  memcpy(y + 2 * n, (double[]){0, 0}, 2 * sizeof *y);
  memcpy(cycle, y, (2 * (size_t)n + 2) * sizeof *y);
  if (event != 0) return kz_parent_of(plane, event, n, cycle, MERGING, y);
  const int points = end->symmetric ? half : n, side = end->symmetric ? -1 : 1;
  memcpy(y + 2 * points, (double[]){0, 0}, 2 * sizeof *y);
  return kz_kind_of(plane, side, points, multiplier, y);
}

double kz_locate_end(const kz_path *path, double stopped, const kz_branch_point *end, int end_kind) {
  const line l = {path, stopped, fmax(fabs(stopped), 1e-3)};
  const double here[2] = {0, 0}, along[2] = {1, 0};
  double y[2 * KZ_CURVE_POINTS + 4] = {end->theta, end->velocity};
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
  const kz_curve_kind kind = cycle_at_end(&plane, end, end_kind, y);
  const int n = 2 * kind.points;
  if (n == 0) return stopped;
  if (!kz_curve_locate(&plane, &kind, y, along) || fabs(y[n]) > NEAR) return stopped;
  return stopped + y[n] * l.size;
}
