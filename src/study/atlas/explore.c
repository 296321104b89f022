/* Where other curves begin: what branches of cycles meet along both axes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "atlas.h"

enum { MOST_ROWS = 500, MOST_EVENTS = 100 };
/* Longest step of a branch; distances from a curve at which its other branches are begun, and how far these may lie from its cycle, rad. */
static const double LONGEST = 0.03, BESIDE[] = {3e-5, 1e-6}, FARTHEST = 0.05;

/* The cycle that a branch grows out of: which one, and the branch's own cycle near it. */
static void add_parent(const kz_atlas *atlas, int event, const kz_atlas_seed *cycle, const double along[2],
                       kz_atlas_seeds *seeds) {
  const int n = cycle->kind.of.points, half = n / 2;
  kz_atlas_kind kind = {{1, 1, -1, 0}, -1};
  double y[KZ_ATLAS_UNKNOWNS], next[4];
  const double *x = cycle->y;
  const int32_t inverted = cos(x[0]) < 0;
  if (event == KZ_EVENT_HALVES || (event == KZ_EVENT_MIRROR && n > 1)) {
    const double side = event == KZ_EVENT_HALVES ? 1 : -1;
    kind.of.points = half;
    kind.of.side = event == KZ_EVENT_HALVES ? 1 : -1;
    const double lift = 2 * M_PI * rint((x[2 * half] - side * x[0]) / (2 * M_PI));
    for (int i = 0; i < half; i++) {
      y[2 * i] = 0.5 * (x[2 * i] + side * (x[2 * (i + half)] - lift));
      y[2 * i + 1] = 0.5 * (x[2 * i + 1] + side * x[2 * (i + half) + 1]);
    }
    next[0] = y[2 * half - 2], next[1] = y[2 * half - 1];
    if (!kz_curve_orbit(&atlas->plane, x + 2 * n, 1, next)) return;
    kind.of.turns = (int32_t)rint((next[2] - side * y[0]) / (2 * M_PI));
  } else {
    kind.rest = inverted;
    kind.of.side = event == KZ_EVENT_MIRROR ? -1 : 1;
    kind.of.turns = event == KZ_EVENT_MIRROR ? inverted : 0;
    y[0] = M_PI * inverted, y[1] = 0;
  }
  const int m = 2 * kind.of.points;
  y[m] = x[2 * n], y[m + 1] = x[2 * n + 1];
  if (kz_curve_locate(&atlas->plane, &kind.of, y, along)) kz_atlas_add(atlas, kind, y, seeds);
}

/* Follows a cycle along a line and adds what it meets. */
static void follow(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *start, const double along[2],
                   kz_atlas_seeds *seeds) {
  const int n = 2 * kind->of.points;
  KZ_FREED double *row = kz_malloc(MOST_ROWS * (size_t)(4 + n) * sizeof *row);
  KZ_FREED double *event = kz_malloc(MOST_EVENTS * (size_t)(3 + n) * sizeof *event);
  int64_t events = 0;
  int32_t ending;
  if (kz_atlas_period(kind) > atlas->max_period) return;
  kz_curve_branch(&atlas->plane, &kind->of, start, along, LONGEST, MOST_ROWS, row, MOST_EVENTS, event, &events, &ending);
  for (int64_t i = 0; i < events; i++) {
    const double *e = event + i * (3 + n);
    kz_atlas_seed at = {.kind = *kind};
    memcpy(at.y, e + 3, (size_t)n * sizeof *at.y);
    at.y[n] = e[1], at.y[n + 1] = e[2];
    if (e[0] > KZ_EVENT_FLIP) {
      add_parent(atlas, (int)e[0], &at, along, seeds);
      continue;
    }
    at.kind.of.multiplier = e[0] == KZ_EVENT_FOLD ? 1 : -1;
    kz_atlas_add(atlas, at.kind, at.y, seeds);
  }
}

void kz_atlas_explore_cycle(const kz_atlas *atlas, const kz_atlas_seed *cycle, kz_atlas_seeds *seeds) {
  for (int i = 0; i < 4; i++) {
    const double along[2] = {i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0};
    follow(atlas, &cycle->kind, cycle->y, along, seeds);
  }
}

/* The cycle beside a curve whose first point is moved by `size` eigenvectors, at the place moved by `by` along an axis. */
static bool beside(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *at, const double *vector, double size,
                   int axis, double by, const kz_atlas_kind *other, double *y) {
  const int n = 2 * other->of.points, m = 2 * kind->of.points;
  double state[2 * KZ_CURVE_POINTS + 2];
  y[n] = at[m], y[n + 1] = at[m + 1];
  y[n + axis] += by;
  state[0] = at[0] + size * vector[0], state[1] = at[1] + size * vector[1];
  if (!kz_curve_orbit(&atlas->plane, y + n, other->of.points, state)) return false;
  memcpy(y, state, (size_t)n * sizeof *y);
  return true;
}

/* Both branches of a fold along an axis, into the side where they exist. */
static void explore_fold(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *at, int axis, double form,
                         double gradient, const double *vector, kz_atlas_seeds *seeds) {
  const double sign = gradient > 0 ? 1 : -1, along[2] = {axis == 0 ? sign : 0, axis == 1 ? sign : 0};
  double size = 0, by = 0, y[KZ_ATLAS_UNKNOWNS];
  for (int i = 0; i < 2; i++) {
    by = BESIDE[i];
    size = sqrt(fabs(gradient) * by / fabs(form));
    if (size < FARTHEST) break;
  }
  for (int branch = -1; branch <= 1; branch += 2)
    if (beside(atlas, kind, at, vector, branch * size, axis, sign * by, kind, y)) follow(atlas, kind, y, along, seeds);
}

/* The cycle itself to both sides along an axis, and its child. */
static void explore_flip(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *at, int axis, double form,
                         double gradient, const double *vector, kz_atlas_seeds *seeds) {
  const kz_atlas_kind child = kz_atlas_child(kind);
  double along[2] = {0}, size = 0, by = 0, y[KZ_ATLAS_UNKNOWNS];
  kz_pendulum pendulum;
  for (int sign = -1; sign <= 1; sign += 2) {
    along[axis] = sign;
    follow(atlas, kind, at, along, seeds);
  }
  if (kz_atlas_period(&child) > atlas->max_period || !kz_atlas_pendulum(atlas->scene, at + 2 * kind->of.points, &pendulum))
    return;
  along[axis] = gradient * form > 0 ? -1 : 1;
  const double other = 1 - exp(-2 * M_PI * pendulum.beta * kind->of.points);
  for (int i = 0; i < 2; i++) {
    by = BESIDE[i];
    size = sqrt(fabs(gradient) * by / other / fabs(form));
    if (size < FARTHEST) break;
  }
  if (beside(atlas, kind, at, vector, size, axis, along[axis] * by, &child, y)) follow(atlas, &child, y, along, seeds);
}

/* The row at a share of those inside of the rectangle. */
static const double *row_at(const kz_atlas_curve *curve, double share) {
  const int64_t width = kz_atlas_width(&curve->kind);
  int64_t inside = 0, n = 0;
  for (int pass = 0; pass < 2; pass++) {
    const int64_t wanted = inside > 0 ? (int64_t)(share * (double)(inside - 1)) : (int64_t)(share * (double)(curve->n - 1));
    n = 0;
    for (int64_t i = 0; i < curve->n; i++) {
      const double *row = curve->row + i * width;
      const bool in = row[0] > 0 && row[0] < 1 && row[1] > 0 && row[1] < 1;
      if (pass == 1 && (in || inside == 0) && n == wanted) return row;
      n += in || (pass == 1 && inside == 0);
    }
    if (pass == 0) inside = n;
  }
  return curve->row;
}

void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, double share, kz_atlas_seeds *seeds) {
  const int n = 2 * curve->kind.of.points;
  const double *row = row_at(curve, share);
  double at[KZ_ATLAS_UNKNOWNS], form, side[2], vector[2];
  memcpy(at, row + KZ_ROW_POINTS, (size_t)n * sizeof *at);
  at[n] = row[0], at[n + 1] = row[1];
  if (!kz_curve_form(&atlas->plane, &curve->kind.of, at, &form, side, vector) || form == 0) return;
  for (int axis = 0; axis < 2; axis++) {
    if (fabs(side[axis]) < 1e-12) continue;
    (curve->kind.of.multiplier > 0 ? explore_fold : explore_flip)(atlas, &curve->kind, at, axis, form, side[axis], vector,
                                                                  seeds);
  }
  kz_atlas_explore_image(atlas, curve, at, seeds);
}

/* The image of a curve's point where the plane has k and -k: half a period later, seen from upside down. */
void kz_atlas_explore_image(const kz_atlas *atlas, const kz_atlas_curve *curve, const double *at, kz_atlas_seeds *seeds) {
  const int n = curve->kind.of.points;
  kz_atlas_kind kind = curve->kind;
  double y[KZ_ATLAS_UNKNOWNS + 2], state[2], place[2];
  if (!atlas->turned || curve->kind.rest >= 0 || !kz_atlas_image(atlas, at + 2 * n, place)) return;
  state[0] = at[0], state[1] = at[1];
  if (!kz_curve_half_period(&atlas->plane, at + 2 * n, state)) return;
  y[0] = M_PI - state[0], y[1] = -state[1];
  if (!kz_curve_orbit(&atlas->plane, place, n, y)) return;
  kind.of.turns = (int32_t)rint((y[2 * n] - kind.of.side * y[0]) / (2 * M_PI));
  for (int axis = 0; axis < 2; axis++) {
    const double along[2] = {axis == 0, axis == 1};
    double moved[KZ_ATLAS_UNKNOWNS];
    memcpy(moved, y, (size_t)(2 * n) * sizeof *moved);
    moved[2 * n] = place[0], moved[2 * n + 1] = place[1];
    if (kz_curve_locate(&atlas->plane, &kind.of, moved, along) && kz_atlas_add(atlas, kind, moved, seeds)) return;
  }
}
