/* One cycle carried along a parameter, and what happens at its ends. */
#include <math.h>

#include "sweep.h"

/* rad: farthest that a strobe point may move in one step. */
static const double MAX_DISTANCE = 0.3;
/* Ends are located to this share of the parameter. */
static const double LOCATED = 1e-10;
/* rad: at the very end of a branch a cycle this near to another one merges with it. */
static const double MERGING = 1e-3;
/* A multiplier this near to the unit circle has reached it. */
static const double NEUTRAL = 0.05;

static bool pendulum_of_scene(const void *context, double value, kz_pendulum *pendulum) {
  return kz_sweep_pendulum(context, value, pendulum);
}

kz_path kz_sweep_path(const kz_scene *scene) {
  return (kz_path){pendulum_of_scene, scene};
}

static bool attracts(const kz_branch_point *point) {
  return hypot(point->multiplier_re[0], point->multiplier_im[0]) < 1;
}

/* The cycle at another value, where it still attracts. */
static bool step_to(const kz_path *path, double value, const kz_branch_point *from, kz_branch_point *to) {
  kz_pendulum pendulum;
  return path->pendulum(path->context, value, &pendulum) && pendulum.beta > 0 &&
         kz_branch_continue(&pendulum, from, MAX_DISTANCE, to) && attracts(to);
}

double kz_walk(const kz_path *path, double from, double to, kz_branch_point *point) {
  const double least = LOCATED * fmax(fabs(from), fabs(to));
  double at = from, step = to - from;
  kz_branch_point there;
  while (at != to) {
    const double next = fabs(step) >= fabs(to - at) ? to : at + step;
    if (step_to(path, next, point, &there)) {
      at = next;
      *point = there;
      step *= 2;
    } else if (fabs(step /= 2) < least) {
      break;
    }
  }
  return at;
}

int kz_end_kind(const kz_branch_point *end) {
  const double re = end->multiplier_re[0];
  if (hypot(re, end->multiplier_im[0]) < 1 - NEUTRAL) return KZ_END_NOT_LOCATED;
  if (end->multiplier_im[0] != 0) return KZ_END_NEIMARK_SACKER;
  if (re < 0) return KZ_END_PERIOD_DOUBLING;
  if (end->symmetric ? end->half_re[0] < 0 : end->mirror_distance < MERGING) return KZ_END_SYMMETRY_BREAKING;
  return end->halves_distance < MERGING ? KZ_END_PERIOD_DOUBLING : KZ_END_FOLD;
}

/* 1 + trace + det: the characteristic polynomial at -1 of the one-period map about inverted. NaN without a pendulum. */
static double flip_test(const kz_path *path, double value) {
  kz_pendulum pendulum;
  kz_branch_point rest = {.theta = M_PI, .period = 1, .symmetric = 1, .centre = 1};
  if (!path->pendulum(path->context, value, &pendulum) || !kz_branch_continue(&pendulum, &rest, MAX_DISTANCE, &rest))
    return NAN;
  return 1 + rest.multiplier_re[0] + rest.multiplier_re[1] + exp(-2 * M_PI * pendulum.beta);
}

double kz_flutter_critical(const kz_path *path, double low, double high) {
  const double at_low = flip_test(path, low), at_high = flip_test(path, high);
  if (!(at_low * at_high <= 0)) return NAN;
  for (;;) {
    const double middle = low + (high - low) / 2, at_middle = flip_test(path, middle);
    if (middle == low || middle == high || at_middle == 0) return middle;
    if (!isfinite(at_middle)) return NAN;
    if ((at_middle > 0) == (at_low > 0))
      low = middle;
    else
      high = middle;
  }
}

/* The direction (unit vector) in which the inverted state leaves by its most negative multiplier; false where it has none. */
static bool leaving_direction(const kz_pendulum *pendulum, double direction[2]) {
  kz_numerics fine;
  double theta = M_PI, velocity = 0, matrix[4];
  int64_t turns = 0;
  kz_numerics_fine(pendulum, &fine);
  kz_flow *flow = kz_flow_create(pendulum, &fine);
  if (!flow) return false;
  kz_advance_tangent(flow, 1, 1, &theta, &velocity, &turns, matrix);
  kz_flow_free(flow);
  const double half = (matrix[0] + matrix[3]) / 2, root = half * half - exp(-2 * M_PI * pendulum->beta);
  if (root < 0) return false;
  const double leaving = half - sqrt(root), length = hypot(matrix[1], leaving - matrix[0]);
  direction[0] = matrix[1] / length;
  direction[1] = (leaving - matrix[0]) / length;
  return leaving < -1 && length > 0;
}

bool kz_flutter_find(const kz_pendulum *pendulum, kz_branch_point *flutter) {
  double direction[2];
  if (!leaving_direction(pendulum, direction)) return false;
  for (double size = 1e-3; size < 1.5; size *= 1.2) {
    const kz_branch_point guess = {
        .theta = remainder(M_PI + size * direction[0], 2 * M_PI), .velocity = size * direction[1], .period = 2, .symmetric = 1};
    if (kz_branch_continue(pendulum, &guess, size / 2, flutter) && flutter->centre == 1 && attracts(flutter)) return true;
  }
  return false;
}
