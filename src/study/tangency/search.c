/* The value at which two manifolds begin to cross: halved by whether traces cross, then the root of their distance. */
#include <math.h>
#include <stdlib.h>

#include "search.h"
#include "arm.h"
#include "kapitza/dynamics_cycles.h"

/* ---- two branches: where they cross, and where they run along each other ---- */

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

/* Sets the places where two branches cross most nearly along each other; returns the sine of their angle there, infinite if they do not cross. */
static double find_crossing(const kz_arm_trace *from, const kz_arm_trace *into, kz_touch *touch) {
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

/* Moves both places to where the branches run along each other, the nearest points opposite; returns the distance between them, with a sign; NaN if
 * Newton's method fails. */
static double gap_between(const kz_arm *from, const kz_arm *into, kz_touch *touch) {
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

enum { HALVINGS = 10, WIDER = 8, PATH = 16 /* steps of a cycle along the whole range */ };
/* rad: a step of a cycle along the range ends so near. */
static const double NEXT = 0.5;
/* How much farther from the cycles branches begin to measure the error. */
static const double FARTHER = 5;
/* The change of the value is one sample of its error, which may be larger. */
static const double MARGIN = 4;

/* The pendulum at a value of the key; false if there is none. */
static bool pendulum_at(const kz_tangency_search *s, double value, kz_pendulum *pendulum) {
  return kz_pendulum_at(s->scene, 1, &s->scene->tangency->axis.parameter, &value, pendulum) && pendulum->beta >= 0;
}

/* Moves a cycle to the pendulum of a value by Newton's method. */
static bool move(const kz_tangency_search *s, double value, kz_hinge *hinge) {
  kz_pendulum pendulum;
  kz_numerics fine;
  kz_attractor cycle;
  if (!pendulum_at(s, value, &pendulum)) return false;
  kz_numerics_fine(&pendulum, &fine);
  kz_dynamics_close_cycle(&pendulum, &fine, hinge->period, NEXT, hinge->theta, hinge->velocity, &cycle);
  return cycle.period == hinge->period;
}

/* Both cycles at a value, in steps from where they are known. */
static bool move_both(kz_tangency_search *s, double value) {
  const kz_axis *range = &s->scene->tangency->axis.values;
  const double way = value - s->value, steps = fmax(1, ceil(fabs(way) * PATH / (range->max - range->min)));
  if (way == 0) return true;
  for (double i = 1; i <= steps; i++)
    if (!move(s, s->value + way * (i / steps), &s->from) || !move(s, s->value + way * (i / steps), &s->into)) return false;
  s->value = value;
  return true;
}

/* One branch at a value; false if that fails. */
static bool make_arm(kz_tangency_search *s, double value, int32_t phase, int32_t side, bool stable, kz_arm *arm) {
  kz_pendulum pendulum;
  *arm = (kz_arm){0};
  return move_both(s, value) && pendulum_at(s, value, &pendulum) &&
         kz_arm_make(&pendulum, stable ? &s->into : &s->from, phase, side, stable, s->nearness, arm);
}

bool kz_tangency_arms(kz_tangency_search *s, double value, const kz_touch *touch, kz_arm arm[2]) {
  const bool first = make_arm(s, value, 0, touch->from_side, false, arm);
  const bool second = make_arm(s, value, touch->phase, touch->into_side, true, arm + 1);
  if (first && second) return true;
  kz_arm_free(arm);
  kz_arm_free(arm + 1);
  return false;
}

/* The trace of one branch at a value; an empty one, and the search is lost, if there is none. */
static kz_arm_trace trace_at(kz_tangency_search *s, double value, int32_t phase, int32_t side, bool stable) {
  kz_arm arm;
  kz_arm_trace trace = {0};
  if (make_arm(s, value, phase, side, stable, &arm))
    trace = kz_arm_trace_make(&arm, s->scene->tangency->length);
  else
    s->lost = true;
  kz_arm_free(&arm);
  return trace;
}

/* Whether any two branches cross at a value, and where they do so at the smallest angle. */
static bool any_cross(kz_tangency_search *s, double value, kz_touch *best) {
  double smallest = INFINITY;
  kz_arm_trace from[2];
  for (int i = 0; i < 2; i++) from[i] = trace_at(s, value, 0, 2 * i - 1, false);
  for (int32_t j = 0; j < 2 * s->into.period && !s->lost; j++) {
    kz_touch touch = {.phase = j / 2, .into_side = 2 * (j % 2) - 1};
    kz_arm_trace into = trace_at(s, value, touch.phase, touch.into_side, true);
    for (int i = 0; i < 2; i++) {
      touch.from_side = 2 * i - 1;
      const double sine = find_crossing(from + i, &into, &touch);
      if (sine < smallest) *best = touch;
      smallest = fmin(sine, smallest);
    }
    kz_arm_trace_free(&into);
  }
  for (int i = 0; i < 2; i++) kz_arm_trace_free(from + i);
  return isfinite(smallest);
}

/* A function for kz_root. */
static double gap_at(double value, void *context) {
  kz_tangency_search *s = context;
  kz_arm arm[2];
  if (!kz_tangency_arms(s, value, &s->touch, arm)) return NAN;
  const double gap = gap_between(arm, arm + 1, &s->touch);
  kz_arm_free(arm);
  kz_arm_free(arm + 1);
  return gap;
}

/* The root of the distance between two values, or a little beyond them. */
static double root_near(kz_tangency_search *s, double apart, double crossed) {
  const kz_touch seed = s->touch;
  double beyond = crossed - apart, root = NAN;
  for (int i = 0; i < WIDER && isnan(root); i++, beyond *= 2) {
    s->touch = seed;
    root = kz_root(gap_at, s, fmin(crossed + beyond, apart - beyond), fmax(crossed + beyond, apart - beyond));
  }
  return root;
}

/* The same value from branches that begin FARTHER times as far from the cycles. */
static double root_again(kz_tangency_search *s, double value, double width) {
  const kz_touch touch = s->touch;
  const double nearness = s->nearness;
  kz_arm arm[2];
  if (!kz_tangency_arms(s, value, &touch, arm)) return NAN;
  s->touch.from_place -= log(FARTHER) / log(arm[0].multiplier);
  s->touch.into_place -= log(FARTHER) / log(arm[1].multiplier);
  kz_arm_free(arm);
  kz_arm_free(arm + 1);
  s->nearness = FARTHER * nearness;
  const double again = root_near(s, value - width, value + width);
  s->nearness = nearness;
  s->touch = touch;
  return again;
}

/* Halves the range by whether branches cross; KZ_REFUSED if they do so at both ends or at neither. */
static kz_status bracket(kz_tangency_search *s, double *apart, double *crossed) {
  const kz_axis *range = &s->scene->tangency->axis.values;
  kz_touch ignored;
  const bool above = any_cross(s, range->max, &s->touch), below = any_cross(s, range->min, above ? &ignored : &s->touch);
  *crossed = above ? range->max : range->min;
  *apart = above ? range->min : range->max;
  if (!s->lost && above == below)
    return kz_fail(KZ_REFUSED, "tangency.max|tangency.min: the manifolds cross at %s; they must cross at one of min and max",
                   above ? "both ends" : "neither end");
  for (int i = 0; i < HALVINGS && !s->lost; i++) {
    const double middle = *crossed + (*apart - *crossed) / 2;
    *(any_cross(s, middle, &s->touch) ? crossed : apart) = middle;
  }
  return s->lost ? kz_fail(KZ_REFUSED,
                           "tangency.max|tangency.min: the cycle ends or is no saddle on the way there; choose a nearer value")
                 : KZ_OK;
}

kz_status kz_tangency_find(kz_tangency_search *s, kz_tangency *found) {
  double apart, crossed;
  KZ_TRY(bracket(s, &apart, &crossed));
  found->above = crossed > apart;
  found->value = root_near(s, apart, crossed);
  if (!isnan(found->value)) found->error = MARGIN * fabs(found->value - root_again(s, found->value, fabs(crossed - apart)));
  if (isnan(found->value) || isnan(found->error))
    return kz_fail(
        KZ_REFUSED,
        "tangency.length: %g leads to manifolds that do not touch smoothly where they begin to cross; choose another one",
        s->scene->tangency->length);
  gap_at(found->value, s);
  return KZ_OK;
}
