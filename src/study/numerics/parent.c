#include "parent.h"

#include <math.h>
#include <string.h>

/* What branches off begins so far from a curve at most: in sides of the plane; in rad; where the multiplier -1 has changed by so much. */
static const double BESIDE = 3e-5, FARTHEST = 0.05, CHANGED = 0.04;

/* The means of the pairs of points that lie half a period apart; side -1: of a point and the mirror image of the other. */
static bool take_means(int points, double side, const double *cycle, double near, double *y) {
  const double lift = 2 * M_PI * rint((cycle[2 * points] - side * cycle[0]) / (2 * M_PI));
  if (!(fabs(cycle[2 * points] - lift - side * cycle[0]) <= near)) return false;
  for (int i = 0; i < points; i++) {
    const double *other = cycle + 2 * (i + points);
    y[2 * i] = 0.5 * (cycle[2 * i] + side * (other[0] - lift));
    y[2 * i + 1] = 0.5 * (cycle[2 * i + 1] + side * other[1]);
  }
  return true;
}

kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int stride, int multiplier, const double *y) {
  const int periods = stride > 1 ? stride : 1;
  KZ_FREED double *next = kz_malloc(2 * ((size_t)periods + 1) * sizeof *next);
  memcpy(next, y + 2 * points - 2, 2 * sizeof *next);
  if (!kz_curve_orbit(plane, y + 2 * points, periods, next)) return (kz_curve_kind){0};
  const int32_t turns = (int32_t)rint((next[2 * periods] - side * y[0]) / (2 * M_PI));
  return (kz_curve_kind){side, points, multiplier, turns, stride};
}

kz_curve_kind kz_parent_of(const kz_plane *plane, int event, const kz_curve_kind *of, const double *cycle, double near,
                           double *parent) {
  const int n = of->points;
  const bool at_rest = event == KZ_EVENT_REST || (event == KZ_EVENT_MIRROR && n == 1);
  const int points = at_rest ? 1 : n / 2, side = event == KZ_EVENT_MIRROR ? -1 : 1;
  if (at_rest)
    parent[0] = cos(cycle[0]) < 0 ? M_PI : 0, parent[1] = 0;
  else if (n % 2 != 0 || !take_means(points, side, cycle, near, parent))
    return (kz_curve_kind){0};
  memcpy(parent + 2 * points, cycle + 2 * n, 2 * sizeof *parent);
  return kz_kind_of(plane, side, points, of->stride, -1, parent);
}

kz_curve_kind kz_child_kind(const kz_curve_kind *kind, int rest) {
  if (rest >= 0 && kind->side > 0) return (kz_curve_kind){-1, 1, 0, rest, 0};
  if (rest >= 0) return (kz_curve_kind){1, 1, 0, 0, 0};
  return (kz_curve_kind){1, 2 * kind->points, 0, kind->side > 0 ? 2 * kind->turns : 0, kind->stride};
}

bool kz_child_of(const kz_plane *plane, const kz_curve_kind *kind, int rest, const double *flip, int axis, double *child,
                 double along[2]) {
  const int n = 2 * kind->points, stride = kind->stride > 1 ? kind->stride : 1;
  const kz_curve_kind of = kz_child_kind(kind, rest);
  const int m = 2 * of.points;
  double form, side[2], vector[2];
  kz_pendulum pendulum;
  if (of.points > KZ_CURVE_POINTS || !plane->pendulum(plane->context, flip + n, &pendulum) ||
      !kz_curve_form(plane, kind, flip, &form, side, vector) || form == 0 || fabs(side[axis]) < KZ_CHILD_FLAT)
    return false;
  const double gradient = side[axis], other = 1 - exp(-2 * M_PI * pendulum.beta * kind->points * stride);
  const double by = fmin(BESIDE, fmin(CHANGED, FARTHEST * FARTHEST * fabs(form)) * other / fabs(gradient));
  const double size = sqrt(fabs(gradient / form) * by / other);
  KZ_FREED double *state = kz_malloc(2 * ((size_t)(of.points * stride) + 1) * sizeof *state);
  const double at_rest[2] = {M_PI * rest, 0},
               *from = rest >= 0 ? at_rest : flip; /* of the angle that the child's turns are for */
  along[axis] = gradient * form > 0 ? -1 : 1;
  along[1 - axis] = 0;
  for (int i = 0; i < 2; i++) {
    child[m + i] = flip[n + i] + by * along[i];
    state[i] = from[i] + size * vector[i];
  }
  if (!kz_curve_orbit(plane, child + m, (of.points - 1) * stride, state)) return false;
  for (int i = 0; i < of.points; i++) memcpy(child + 2 * i, state + 2 * i * stride, 2 * sizeof *child);
  return true;
}
