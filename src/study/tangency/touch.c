/* Two branches: where they cross, and where they run along each other. */
#include <math.h>
#include <stdlib.h>

#include "arm.h"

enum { MOST_STEPS = 30 };
/* Of a place: step of differences; the last step of Newton's method. Places may move so far. */
static const double STEP = 1e-5, CLOSE = 1e-9, FAR = 2;

static double cross(const double *a, const double *b) {
  return a[0] * b[1] - a[1] * b[0];
}

/* From a to b: angle on the circle, velocity. */
static void gap_of(const kz_arm_point *a, const kz_arm_point *b, double *gap) {
  gap[0] = remainder(b->theta - a->theta, 2 * M_PI);
  gap[1] = b->velocity - a->velocity;
}

/* Whether the pieces a[0] a[1] and b[0] b[1] cross, and at which shares of them. */
static bool pieces_cross(const kz_arm_point *a, const kz_arm_point *b, double *on_a, double *on_b) {
  double along_a[2], along_b[2], between[2];
  gap_of(a, b, between);
  if (fabs(between[0]) + fabs(between[1]) > 0.2) return false;
  gap_of(a, a + 1, along_a);
  gap_of(b, b + 1, along_b);
  const double area = cross(along_a, along_b);
  *on_a = cross(between, along_b) / area;
  *on_b = cross(between, along_a) / area;
  return *on_a >= 0 && *on_a < 1 && *on_b >= 0 && *on_b < 1;
}

static double sine_of(const kz_arm_point *a, const kz_arm_point *b) {
  return cross(a->tangent, b->tangent) / (hypot(a->tangent[0], a->tangent[1]) * hypot(b->tangent[0], b->tangent[1]));
}

double kz_arm_traces_cross(const kz_arm_trace *from, const kz_arm_trace *into, kz_touch *touch) {
  double smallest = INFINITY;
  for (int64_t i = 0; i + 1 < from->n; i++)
    for (int64_t j = 0; j + 1 < into->n; j++) {
      const kz_arm_point *a = from->point + i, *b = into->point + j;
      double on_a, on_b;
      if (!pieces_cross(a, b, &on_a, &on_b) || fabs(sine_of(a, b)) >= smallest) continue;
      smallest = fabs(sine_of(a, b));
      touch->from_place = from->place[i] + on_a * (from->place[i + 1] - from->place[i]);
      touch->into_place = into->place[j] + on_b * (into->place[j + 1] - into->place[j]);
    }
  return smallest;
}

/* What vanishes at the nearest points where the branches are parallel: the distance along the first branch, and the sine of the angle. */
static void conditions(const kz_arm *from, const kz_arm *into, const double *place, double *value, double *across) {
  kz_arm_point a, b;
  double gap[2];
  kz_arm_points(from, 1, place, &a);
  kz_arm_points(into, 1, place + 1, &b);
  gap_of(&a, &b, gap);
  const double speed = hypot(a.tangent[0], a.tangent[1]);
  value[0] = (gap[0] * a.tangent[0] + gap[1] * a.tangent[1]) / speed;
  value[1] = sine_of(&a, &b);
  *across = cross(a.tangent, gap) / speed;
}

double kz_arms_gap(const kz_arm *from, const kz_arm *into, kz_touch *touch) {
  double place[2] = {touch->from_place, touch->into_place}, across = NAN;
  for (int i = 0; i < MOST_STEPS; i++) {
    double value[2], high[2], low[2], slope[2][2], ignored; /* slope[j] = derivatives by place j */
    conditions(from, into, place, value, &across);
    for (int j = 0; j < 2; j++) {
      double other[2] = {place[0], place[1]};
      other[j] = place[j] + STEP;
      conditions(from, into, other, high, &ignored);
      other[j] = place[j] - STEP;
      conditions(from, into, other, low, &ignored);
      for (int c = 0; c < 2; c++) slope[j][c] = (high[c] - low[c]) / (2 * STEP);
    }
    const double area = cross(slope[0], slope[1]);
    const double step[2] = {-cross(value, slope[1]) / area, -cross(slope[0], value) / area};
    const double most = fmax(fabs(step[0]), fabs(step[1])), part = fmin(1, 0.1 / most);
    for (int j = 0; j < 2; j++) place[j] += part * step[j];
    if (!(fabs(place[0] - touch->from_place) + fabs(place[1] - touch->into_place) < FAR)) return NAN;
    if (most < CLOSE) {
      touch->from_place = place[0];
      touch->into_place = place[1];
      return across;
    }
  }
  return NAN;
}
