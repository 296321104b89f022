#include "parent.h"

#include <math.h>
#include <string.h>

/* Largest distance from a curve where a branch begins: sides of the plane; rad; change of the multiplier -1. */
static const double BESIDE = 3e-5, FARTHEST = 0.05, CHANGED = 0.04;
/* Loss of area over the cycle at which a child begins as near as rounding allows; with less it is no nearer. */
static const double LEAST_DAMPED = 2e-3;

/* Means of points half a period apart; side -1: of a point and the other's mirror image. */
static bool take_means(int points, double side, const double *cycle, double *y) {
  const double lift = 2 * M_PI * rint((cycle[2 * points] - side * cycle[0]) / (2 * M_PI));
  if (isnan(cycle[2 * points] - lift - side * cycle[0])) return false;
  for (int i = 0; i < points; i++) {
    const double *other = cycle + 2 * (i + points);
    y[2 * i] = 0.5 * (cycle[2 * i] + side * (other[0] - lift));
    y[2 * i + 1] = 0.5 * (cycle[2 * i + 1] + side * other[1]);
  }
  return true;
}

/* Means of an odd cycle's points and their images half a period later, over the first half of them. */
static bool take_image_means(const kz_plane *plane, int n, const double *cycle, double *y) {
  for (int i = 0; i < (n + 1) / 2; i++) {
    const double *own = cycle + 2 * i, *other = cycle + 2 * ((i + n / 2) % n);
    double state[4] = {other[0], other[1]};
    if (!kz_curve_orbit(plane, cycle + 2 * n, 1, 1, state)) return false;
    y[2 * i] = own[0] - 0.5 * remainder(own[0] + state[2], 2 * M_PI);
    y[2 * i + 1] = 0.5 * (own[1] - state[3]);
  }
  return true;
}

kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int stride, int multiplier, const double *y) {
  const int half = side < 0 && plane->half_period, periods = kz_larger(stride, 1) - half;
  KZ_AUTOFREE double *next = kz_malloc(2 * ((size_t)periods + 2) * sizeof *next);
  memcpy(next, y + 2 * points - 2, 2 * sizeof *next);
  if (!kz_curve_orbit(plane, y + 2 * points, 2, periods, next)) return (kz_curve_kind){0};
  if (half && !kz_curve_orbit(plane, y + 2 * points, 1, 1, next + 2 * periods)) return (kz_curve_kind){0};
  const int32_t turns = (int32_t)rint((next[2 * (periods + half)] - side * y[0]) / (2 * M_PI));
  return (kz_curve_kind){side, points, multiplier, turns, stride, half};
}

int32_t kz_kind_period(const kz_cycle_kind *kind) {
  const int stride = kind->of.stride > 1 ? kind->of.stride : 1;
  return kind->rest >= 0 ? 1 : kind->of.points * stride * (kind->of.side < 0 ? 2 : 1) - kind->of.half;
}

double kz_kind_determinant(const kz_curve_kind *kind, double beta) {
  return exp(-M_PI * beta * (2 * kind->points * kz_larger(kind->stride, 1) - kind->half));
}

bool kz_parent_of(const kz_plane *plane, kz_event event, const kz_plane_cycle *cycle, kz_plane_cycle *parent) {
  const int n = cycle->kind.of.points;
  const bool half = event == KZ_EVENT_MIRROR && plane->half_period;
  const bool at_rest = event == KZ_EVENT_REST || (event == KZ_EVENT_MIRROR && n == 1 && !half);
  const int points = at_rest ? 1 : (n + half) / 2, side = event == KZ_EVENT_MIRROR ? -1 : 1;
  *parent = (kz_plane_cycle){.kind.rest = at_rest ? cos(cycle->y[0]) < 0 : -1};
  if (at_rest)
    parent->y[0] = M_PI * parent->kind.rest;
  else if (half) {
    if (cycle->kind.of.stride > 1 || !take_image_means(plane, n, cycle->y, parent->y)) return false;
  } else if (n % 2 != 0 || !take_means(points, side, cycle->y, parent->y))
    return false;
  memcpy(parent->y + 2 * points, cycle->y + 2 * n, 2 * sizeof *parent->y);
  parent->kind.of = kz_kind_of(plane, side, points, cycle->kind.of.stride, -1, parent->y);
  return parent->kind.of.points > 0;
}

kz_cycle_kind kz_child_kind(const kz_cycle_kind *kind) {
  const kz_curve_kind *of = &kind->of;
  if (kind->rest >= 0 && of->side > 0) return (kz_cycle_kind){{-1, 1, 0, kind->rest, 0}, -1};
  if (kind->rest >= 0) return (kz_cycle_kind){{1, 1, 0, 0, 0}, -1};
  if (!of->half) return (kz_cycle_kind){{1, 2 * of->points, 0, of->side > 0 ? 2 * of->turns : 0, of->stride}, -1};
  const int32_t period = kz_kind_period(kind);
  int32_t stride = 1;
  while (period % stride != 0 || period / stride > KZ_CURVE_POINTS) stride++;
  return (kz_cycle_kind){{1, period / stride, 0, 0, stride > 1 ? stride : 0}, -1};
}

bool kz_child_of(const kz_plane *plane, const kz_plane_cycle *flip, int axis, kz_plane_cycle *child, double along[2]) {
  const kz_curve_kind *kind = &flip->kind.of;
  const int n = 2 * kind->points;
  *child = (kz_plane_cycle){.kind = kz_child_kind(&flip->kind)};
  const kz_curve_kind of = child->kind.of;
  const int m = 2 * of.points, stride = kz_larger(of.stride, 1);
  double form, side[2], vector[2];
  kz_pendulum pendulum;
  if (of.points > KZ_CURVE_POINTS || !plane->pendulum(plane->context, flip->y + n, &pendulum) ||
      !kz_curve_form(plane, kind, flip->y, &form, side, vector) || form == 0 || fabs(side[axis]) < KZ_CHILD_FLAT)
    return false;
  const double gradient = side[axis], other = 1 - kz_kind_determinant(kind, pendulum.beta);
  const double by = fmin(
      BESIDE, fmin(CHANGED * fmax(other, LEAST_DAMPED), FARTHEST * FARTHEST * fabs(form) * other) / fabs(gradient));
  const double size = sqrt(fabs(gradient / form) * by / other);
  KZ_AUTOFREE double *state = kz_malloc(2 * ((size_t)(of.points * stride) + 1) * sizeof *state);
  const double at_rest[2] = {M_PI * flip->kind.rest, 0},
               *from = flip->kind.rest >= 0 ? at_rest : flip->y; /* angle that the child's turns are for */
  along[axis] = gradient * form > 0 ? -1 : 1;
  along[1 - axis] = 0;
  for (int i = 0; i < 2; i++) {
    child->y[m + i] = flip->y[n + i] + by * along[i];
    state[i] = from[i] + size * vector[i];
  }
  if (!kz_curve_orbit(plane, child->y + m, 2, (of.points - 1) * stride, state)) return false;
  for (int i = 0; i < of.points; i++) memcpy(child->y + 2 * i, state + 2 * i * stride, 2 * sizeof *child->y);
  return true;
}
