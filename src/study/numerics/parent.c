#include "parent.h"

/* Largest distance from a curve at which a branch begins: in sides of the plane; in rad; where the multiplier -1 has
 * changed by so much. */
static const double BESIDE = 3e-5, FARTHEST = 0.05, CHANGED = 0.04;
/* Loss of area over the cycle at which a child begins as near as rounding allows; with less it is no nearer. */
static const double LEAST_DAMPED = 2e-3;

/* The means of the pairs of points that lie half a period apart; with the parent's side -1 of a point and the mirror
 * image of the other. */
static bool take_means(const kz_cycle *cycle, kz_cycle *parent) {
  const int points = parent->kind.points;
  const double side = parent->kind.side;
  const double lift = 2 * M_PI * rint((cycle->point[points][0] - side * cycle->point[0][0]) / (2 * M_PI));
  if (isnan(cycle->point[points][0] - lift - side * cycle->point[0][0])) return false;
  for (int i = 0; i < points; i++) {
    const double *own = cycle->point[i], *other = cycle->point[i + points];
    parent->point[i][0] = 0.5 * (own[0] + side * (other[0] - lift));
    parent->point[i][1] = 0.5 * (own[1] + side * other[1]);
  }
  return true;
}

/* Means of the points of a cycle of an odd number of periods and of its images, half a period later: of the first half
 * of them. */
static bool take_image_means(const kz_plane *plane, const kz_cycle *cycle, kz_cycle *parent) {
  const int n = cycle->kind.points;
  for (int i = 0; i < (n + 1) / 2; i++) {
    const double *own = cycle->point[i], *other = cycle->point[(i + n / 2) % n];
    double state[4] = {other[0], other[1]};
    if (!kz_curve_orbit(plane, cycle->place, 1, 1, state)) return false;
    parent->point[i][0] = own[0] - 0.5 * remainder(own[0] + state[2], 2 * M_PI);
    parent->point[i][1] = 0.5 * (own[1] - state[3]);
  }
  return true;
}

bool kz_cycle_close(const kz_plane *plane, kz_cycle *cycle) {
  kz_cycle_kind *kind = &cycle->kind;
  const int half = kind->side < 0 && plane->half_period, periods = kz_larger(kind->stride, 1) - half;
  KZ_AUTOFREE double *next = kz_malloc(2 * ((size_t)periods + 2) * sizeof *next);
  memcpy(next, cycle->point[kind->points - 1], 2 * sizeof *next);
  kind->half = half, kind->turns = 0;
  if (!kz_curve_orbit(plane, cycle->place, 2, periods, next)) return false;
  if (half && !kz_curve_orbit(plane, cycle->place, 1, 1, next + 2 * periods)) return false;
  kind->turns = (int32_t)rint((next[2 * (periods + half)] - kind->side * cycle->point[0][0]) / (2 * M_PI));
  return true;
}

int32_t kz_kind_period(const kz_cycle_kind *kind) {
  const int stride = kind->stride > 1 ? kind->stride : 1;
  return kind->rest ? 1 : kind->points * stride * (kind->side < 0 ? 2 : 1) - kind->half;
}

double kz_kind_determinant(const kz_cycle_kind *kind, double beta) {
  return exp(-M_PI * beta * (2 * kind->points * kz_larger(kind->stride, 1) - kind->half));
}

bool kz_cycle_parent(const kz_plane *plane, const kz_cycle *event, kz_cycle *parent) {
  const int n = event->kind.points;
  const bool mirror = event->event == KZ_EVENT_MIRROR, half = mirror && plane->half_period;
  const bool at_rest = event->event == KZ_EVENT_REST || (mirror && n == 1 && !half);
  *parent = (kz_cycle){.kind = {.side = mirror ? -1 : 1,
                                .points = at_rest ? 1 : (n + half) / 2,
                                .multiplier = -1,
                                .stride = event->kind.stride,
                                .rest = at_rest ? 1 + (cos(event->point[0][0]) < 0) : 0},
                       .place = {event->place[0], event->place[1]}};
  if (at_rest)
    parent->point[0][0] = kz_kind_rest(&parent->kind);
  else if (half ? event->kind.stride > 1 || !take_image_means(plane, event, parent)
                : n % 2 != 0 || !take_means(event, parent))
    return false;
  return kz_cycle_close(plane, parent);
}

kz_cycle_kind kz_child_kind(const kz_cycle_kind *kind) {
  if (kind->rest && kind->side > 0) return (kz_cycle_kind){.side = -1, .points = 1, .turns = kind->rest - 1};
  if (kind->rest) return (kz_cycle_kind){.side = 1, .points = 1};
  if (!kind->half)
    return (kz_cycle_kind){
        .side = 1, .points = 2 * kind->points, .turns = kind->side > 0 ? 2 * kind->turns : 0, .stride = kind->stride};
  const int32_t period = kz_kind_period(kind);
  int32_t stride = 1;
  while (period % stride != 0 || period / stride > KZ_CURVE_POINTS) stride++;
  return (kz_cycle_kind){.side = 1, .points = period / stride, .stride = stride > 1 ? stride : 0};
}

bool kz_cycle_child(const kz_plane *plane, const kz_cycle *flip, int axis, kz_cycle *child, double along[2]) {
  *child = (kz_cycle){.kind = kz_child_kind(&flip->kind)};
  const int points = child->kind.points, stride = kz_larger(child->kind.stride, 1);
  kz_normal_form form;
  kz_pendulum pendulum;
  if (points > KZ_CURVE_POINTS || !plane->pendulum(plane->context, flip->place, &pendulum) ||
      !kz_cycle_form(plane, flip, &form) || form.coefficient == 0 || fabs(form.side[axis]) < KZ_CHILD_FLAT)
    return false;
  const double gradient = form.side[axis], other = 1 - kz_kind_determinant(&flip->kind, pendulum.beta);
  const double by =
      fmin(BESIDE, fmin(CHANGED * fmax(other, LEAST_DAMPED), FARTHEST * FARTHEST * fabs(form.coefficient) * other) /
                       fabs(gradient));
  const double size = sqrt(fabs(gradient / form.coefficient) * by / other);
  KZ_AUTOFREE double *state = kz_malloc(2 * ((size_t)(points * stride) + 1) * sizeof *state);
  const double at_rest[2] = {kz_kind_rest(&flip->kind), 0},
               *from = flip->kind.rest ? at_rest : flip->point[0]; /* angle that the child's turns are for */
  along[axis] = gradient * form.coefficient > 0 ? -1 : 1;
  along[1 - axis] = 0;
  for (int i = 0; i < 2; i++) {
    child->place[i] = flip->place[i] + by * along[i];
    state[i] = from[i] + size * form.vector[i];
  }
  if (!kz_curve_orbit(plane, child->place, 2, (points - 1) * stride, state)) return false;
  for (int i = 0; i < points; i++) memcpy(child->point[i], state + 2 * i * stride, sizeof child->point[i]);
  return true;
}
