/* Where other curves begin: what branches of cycles meet along both axes, and along lines through the whole plane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "atlas.h"

enum { MOST_ROWS = 500, MOST_EVENTS = 100 };
/* Longest step of a branch. What branches off begins so far from a curve at most: in sides of the plane; in rad; where the multiplier -1 has
 * changed by so much. */
static const double LONGEST = 0.03, BESIDE = 3e-5, FARTHEST = 0.05, CHANGED = 0.04;

/* A line through the plane: the curves that cross it, and what of them branches have met already. */
typedef struct {
  kz_atlas *atlas;
  int axis; /* the coordinate that varies */
  kz_atlas_crossings crossings;
  bool *itself, *child; /* [crossings] */
  kz_atlas_seeds *seeds;
} line;

/* Marks the crossing that a branch has met; what is no crossing becomes a seed. `child`: by the branch that begins there. */
static void meet(const line *l, const kz_atlas_seed *seed, bool child) {
  const double at = seed->y[2 * seed->kind.of.points + l->axis];
  const int64_t curve = kz_atlas_known(l->atlas, seed);
  int64_t nearest = -1;
  for (int64_t i = 0; i < l->crossings.count && curve >= 0; i++)
    if (l->crossings.list[i].curve == curve &&
        (nearest < 0 || fabs(l->crossings.list[i].at - at) < fabs(l->crossings.list[nearest].at - at)))
      nearest = i;
  if (nearest >= 0)
    (child ? l->child : l->itself)[nearest] = true;
  else if (curve < 0)
    kz_atlas_add(l->atlas, seed->kind, seed->y, l->seeds);
}

/* Takes what a branch has met: to a line, or as a seed. */
static void take(const kz_atlas *atlas, const line *l, kz_atlas_kind kind, const double *y, bool child, kz_atlas_seeds *seeds) {
  KZ_FREED_BY(kz_atlas_seeds_free) kz_atlas_seeds one = {0};
  if (!kz_atlas_add(atlas, kind, y, l ? &one : seeds) || !l) return;
  meet(l, one.list, child);
}

/* The cycle that a branch grows out of: which one, and the branch's own cycle near it. */
static void add_parent(const kz_atlas *atlas, const line *l, int event, const kz_atlas_seed *cycle, const double along[2],
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
  if (kz_curve_locate(&atlas->plane, &kind.of, y, along)) take(atlas, l, kind, y, true, seeds);
}

/* Follows a cycle along a line and adds what it meets; side 1 or -1: one of the branches of a fold. */
static void follow(const kz_atlas *atlas, const line *l, const kz_atlas_kind *kind, const double *start, const double along[2],
                   int32_t side, kz_atlas_seeds *seeds) {
  const int n = 2 * kind->of.points;
  KZ_FREED double *row = kz_malloc(MOST_ROWS * (size_t)(4 + n) * sizeof *row);
  KZ_FREED double *event = kz_malloc(MOST_EVENTS * (size_t)(3 + n) * sizeof *event);
  int64_t events = 0;
  int32_t ending;
  if (kz_atlas_period(kind) > atlas->max_period) return;
  kz_curve_branch(&atlas->plane, &kind->of, start, along, side, LONGEST, MOST_ROWS, row, MOST_EVENTS, event, &events, &ending);
  for (int64_t i = 0; i < events; i++) {
    const double *e = event + i * (3 + n);
    kz_atlas_seed at = {.kind = *kind};
    memcpy(at.y, e + 3, (size_t)n * sizeof *at.y);
    at.y[n] = e[1], at.y[n + 1] = e[2];
    if (e[0] > KZ_EVENT_FLIP) {
      add_parent(atlas, l, (int)e[0], &at, along, seeds);
      continue;
    }
    at.kind.of.multiplier = e[0] == KZ_EVENT_FOLD ? 1 : -1;
    take(atlas, l, at.kind, at.y, false, seeds);
  }
}

void kz_atlas_explore_cycle(const kz_atlas *atlas, const kz_atlas_seed *cycle, kz_atlas_seeds *seeds) {
  for (int i = 0; i < 4; i++) {
    const double along[2] = {i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0};
    follow(atlas, NULL, &cycle->kind, cycle->y, along, 0, seeds);
  }
}

/* Both branches of a fold along an axis. */
static void explore_fold(const kz_atlas *atlas, const line *l, const kz_atlas_kind *kind, const double *at, int axis,
                         kz_atlas_seeds *seeds) {
  const double along[2] = {axis == 0, axis == 1};
  for (int side = -1; side <= 1; side += 2) follow(atlas, l, kind, at, along, side, seeds);
}

/* The cycle to both sides along an axis, if `itself`, and what branches off, if `grown`. */
static void explore_flip(const kz_atlas *atlas, const line *l, const kz_atlas_kind *kind, const double *at, int axis,
                         double form, double gradient, const double *vector, bool itself, bool grown, kz_atlas_seeds *seeds) {
  const kz_atlas_kind child = kz_atlas_child(kind);
  double along[2] = {0}, y[KZ_ATLAS_UNKNOWNS], state[2 * KZ_CURVE_POINTS + 2];
  kz_pendulum pendulum;
  const int n = 2 * kind->of.points, m = 2 * child.of.points;
  for (int sign = -1; sign <= 1 && itself; sign += 2) {
    along[axis] = sign;
    follow(atlas, l, kind, at, along, 0, seeds);
  }
  if (!grown || kz_atlas_period(&child) > atlas->max_period || !kz_atlas_pendulum(atlas->scene, at + n, &pendulum)) return;
  const double other = 1 - exp(-2 * M_PI * pendulum.beta * kind->of.points);
  const double by = fmin(BESIDE, fmin(CHANGED, FARTHEST * FARTHEST * fabs(form)) * other / fabs(gradient));
  const double size = sqrt(fabs(gradient / form) * by / other);
  along[axis] = gradient * form > 0 ? -1 : 1;
  y[m] = at[n] + by * along[0], y[m + 1] = at[n + 1] + by * along[1];
  state[0] = at[0] + size * vector[0], state[1] = at[1] + size * vector[1];
  if (!kz_curve_orbit(&atlas->plane, y + m, child.of.points, state)) return;
  memcpy(y, state, (size_t)m * sizeof *y);
  follow(atlas, l, &child, y, along, 0, seeds);
}

/* Everything that branches off a point of a curve along an axis. */
static void explore_at(const kz_atlas *atlas, const line *l, const kz_atlas_kind *kind, const double *at, int axis, bool itself,
                       bool grown, kz_atlas_seeds *seeds) {
  double form, side[2], vector[2];
  if (!kz_curve_form(&atlas->plane, &kind->of, at, &form, side, vector) || form == 0 || fabs(side[axis]) < 1e-12) return;
  if (kind->of.multiplier > 0)
    explore_fold(atlas, l, kind, at, axis, seeds);
  else
    explore_flip(atlas, l, kind, at, axis, form, side[axis], vector, itself, grown, seeds);
}

/* A fold of what branches off begins where the normal form of a curve with multiplier -1 is 0: explored beside, where it is < 0. */
static void explore_degenerate(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  enum { AWAY = 2 };
  double at[KZ_ATLAS_UNKNOWNS];
  const int64_t width = kz_atlas_width(&curve->kind);
  for (int64_t row = 0; row + 1 < curve->n && curve->kind.of.multiplier < 0; row++) {
    const double a = curve->row[row * width + KZ_ROW_FORM], b = curve->row[(row + 1) * width + KZ_ROW_FORM];
    if ((a > 0) == (b > 0)) continue;
    for (int i = 0; i <= AWAY; i += AWAY) {
      const int64_t beside_it = a < 0 ? row - i : row + 1 + i;
      if (beside_it < 0 || beside_it >= curve->n) continue;
      kz_atlas_point_of(curve, beside_it, at);
      for (int axis = 0; axis < 2; axis++) explore_at(atlas, NULL, &curve->kind, at, axis, false, true, seeds);
    }
  }
}

static bool is_inside(const double *place) {
  return place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 1;
}

void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, bool middle, kz_atlas_seeds *seeds) {
  enum { IMAGES = 5 };
  const int64_t width = kz_atlas_width(&curve->kind);
  double at[KZ_ATLAS_UNKNOWNS];
  int64_t inside = 0, n = 0;
  for (int64_t row = 0; row < curve->n; row++) inside += is_inside(curve->row + row * width);
  for (int64_t row = 0; row < curve->n; row++) {
    if (inside > 0 && !is_inside(curve->row + row * width)) continue;
    const int64_t all = inside > 0 ? inside : curve->n;
    kz_atlas_point_of(curve, row, at);
    for (int axis = 0; axis < 2 && middle && n == all / 2; axis++)
      explore_at(atlas, NULL, &curve->kind, at, axis, true, true, seeds);
    if (n * IMAGES / all != (n + 1) * IMAGES / all) kz_atlas_explore_image(atlas, curve, at, seeds);
    n++;
  }
  explore_degenerate(atlas, curve, seeds);
}

/* The point where a curve crosses a line. */
static bool crossing_point(const line *l, const kz_atlas_crossing *crossing, double value, double *at) {
  const kz_atlas_curve *curve = l->atlas->curve + crossing->curve;
  const int n = 2 * curve->kind.of.points;
  const double along[2] = {l->axis == 0, l->axis == 1};
  double next[KZ_ATLAS_UNKNOWNS];
  bool jumps = false; /* the last point of a closed curve may be written in another way */
  kz_atlas_point_of(curve, crossing->row, at);
  kz_atlas_point_of(curve, crossing->row + 1, next);
  for (int i = 0; i < n; i++) jumps = jumps || fabs(next[i] - at[i]) > 1;
  for (int i = 0; i < n && !jumps; i++) at[i] += crossing->share * (next[i] - at[i]);
  at[n + l->axis] = crossing->at;
  at[n + 1 - l->axis] = value;
  return kz_curve_locate(&l->atlas->plane, &curve->kind.of, at, along) && fabs(at[n + l->axis] - crossing->at) < 1e-3;
}

void kz_atlas_explore_line(kz_atlas *atlas, int axis, double value, int64_t first, kz_atlas_seeds *seeds) {
  line l = {.atlas = atlas, .axis = axis, .seeds = seeds};
  double at[KZ_ATLAS_UNKNOWNS];
  kz_atlas_crossings_of(atlas, 1 - axis, value, false, &l.crossings);
  KZ_FREED bool *itself = kz_calloc((size_t)l.crossings.count + 1, 1);
  KZ_FREED bool *child = kz_calloc((size_t)l.crossings.count + 1, 1);
  l.itself = itself, l.child = child;
  for (int64_t i = 0; i < l.crossings.count; i++) {
    const kz_atlas_crossing *crossing = l.crossings.list + i;
    const kz_atlas_kind *kind = &atlas->curve[crossing->curve].kind;
    const double share = crossing->at;
    if (crossing->curve < first || share < 0 || share > 1 || (itself[i] && (child[i] || kind->of.multiplier > 0))) continue;
    if (crossing_point(&l, crossing, value, at)) explore_at(atlas, &l, kind, at, axis, !itself[i], !child[i], seeds);
    itself[i] = child[i] = true;
  }
  kz_atlas_crossings_free(&l.crossings);
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
