/* Where other curves begin: what branches of cycles meet along both axes, and along lines through the whole plane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lines.h"
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "branch.h"

/* IMAGES: of a curve, or of a piece of it. */
enum { MOST_ROWS = 500, MOST_EVENTS = 100, IMAGES = 5 };
/* Longest step of a branch, in sides of the plane. */
static const double LONGEST = KZ_ATLAS_BRANCH_STEP;
/* Along an axis on which a curve's number changes less than this nothing branches off. */
static const double FLAT = KZ_CHILD_FLAT;

/* A line through the plane: the curves that cross it, and what of them branches have met already. */
typedef struct {
  kz_atlas *atlas;
  int axis; /* the coordinate that varies */
  kz_atlas_crossings crossings;
  bool *itself, *child; /* [crossings] */
  kz_atlas_seeds *seeds;
  kz_atlas_branches *drawn; /* NULL: the branches are not kept */
} line;

/* Marks the crossing that a branch has met; any other place becomes a seed. `child`: met by the branch born there. */
static void explore_meet(const line *l, const kz_plane_cycle *seed, bool child) {
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
static void explore_take(const kz_atlas *atlas, const line *l, kz_cycle_kind kind, const double *y, bool child,
                         kz_atlas_seeds *seeds) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds one = {0};
  if (!kz_atlas_add(atlas, kind, y, l ? &one : seeds) || !l) return;
  explore_meet(l, one.list, child);
}

/* The cycle that a branch grows out of: which one, and the branch's own cycle near it. */
static void add_parent(const kz_atlas *atlas, const line *l, kz_event event, const kz_plane_cycle *cycle,
                       const double along[2], kz_atlas_seeds *seeds) {
  kz_plane_cycle parent;
  if (kz_parent_of(&atlas->plane, event, cycle, &parent) &&
      kz_curve_locate(&atlas->plane, &parent.kind.of, parent.y, along))
    explore_take(atlas, l, parent.kind, parent.y, true, seeds);
}

/* Follows a cycle along a line and adds what it meets. */
static void follow_to(const kz_atlas *atlas, const line *l, const kz_cycle_kind *kind, const double *start,
                      const kz_branch_way *way, kz_atlas_seeds *seeds) {
  KZ_AUTOFREE kz_branch_row *row = kz_malloc(MOST_ROWS * sizeof *row);
  KZ_AUTOFREE kz_branch_event *event = kz_malloc(MOST_EVENTS * sizeof *event);
  kz_branch_end end;
  if (kz_kind_period(kind) > atlas->scene->atlas->max_period) return;
  kz_curve_branch(&atlas->plane, &kind->of, start, way, row, event, &end);
  if (l && l->drawn) kz_atlas_draw(atlas, l->axis, kind, row, event, &end, l->drawn);
  for (int64_t i = 0; i < end.events; i++) {
    kz_plane_cycle at = {.kind = *kind};
    memcpy(at.y, event[i].y, sizeof at.y);
    if (event[i].what > KZ_EVENT_FLIP) {
      add_parent(atlas, l, event[i].what, &at, way->along, seeds);
      continue;
    }
    at.kind.of.multiplier = event[i].what == KZ_EVENT_FOLD ? 1 : -1;
    explore_take(atlas, l, at.kind, at.y, false, seeds);
  }
}

static void explore_follow(const kz_atlas *atlas, const line *l, const kz_cycle_kind *kind, const double *start,
                           const double along[2], int32_t side, kz_atlas_seeds *seeds) {
  follow_to(atlas, l, kind, start, &(kz_branch_way){{along[0], along[1]}, LONGEST, 0, MOST_ROWS, MOST_EVENTS, side},
            seeds);
}

/* To the right, to the left, up, down. */
static void explore_direction(int i, double along[2]) {
  const double x[] = {1, -1, 0, 0}, y[] = {0, 0, 1, -1};
  along[0] = x[i], along[1] = y[i];
}

void kz_atlas_explore_first(const kz_atlas *atlas, const kz_plane_cycle *cycle, kz_atlas_seeds *seeds) {
  const int64_t before = seeds->count;
  for (int i = 3; i >= 0 && seeds->count == before; i--) {
    kz_branch_way way = {.longest = LONGEST, .most = MOST_ROWS, .most_events = 1};
    explore_direction(i, way.along);
    follow_to(atlas, NULL, &cycle->kind, cycle->y, &way, seeds);
  }
}

/* Both branches of a fold along an axis. */
static void explore_fold(const kz_atlas *atlas, const line *l, const kz_cycle_kind *kind, const double *at, int axis,
                         kz_atlas_seeds *seeds) {
  const double along[2] = {axis == 0, axis == 1};
  for (int side = -1; side <= 1; side += 2) explore_follow(atlas, l, kind, at, along, side, seeds);
}

bool kz_atlas_grown(const kz_atlas *atlas, const kz_plane_cycle *flip, int axis, kz_plane_cycle *child,
                    double along[2]) {
  const kz_cycle_kind kind = kz_child_kind(&flip->kind);
  return kz_kind_period(&kind) <= atlas->scene->atlas->max_period &&
         kz_child_of(&atlas->plane, flip, axis, child, along);
}

/* The cycle to both sides along an axis, if `itself`, and what branches off, if `grown`. */
static void explore_flip(const kz_atlas *atlas, const line *l, const kz_plane_cycle *flip, int axis, bool itself,
                         bool grown, kz_atlas_seeds *seeds) {
  double along[2] = {0};
  kz_plane_cycle child;
  for (int sign = -1; sign <= 1 && itself; sign += 2) {
    along[axis] = sign;
    explore_follow(atlas, l, &flip->kind, flip->y, along, 0, seeds);
  }
  if (grown && kz_atlas_grown(atlas, flip, axis, &child, along))
    explore_follow(atlas, l, &child.kind, child.y, along, 0, seeds);
}

/* Everything that branches off a point of a curve along an axis. */
static void explore_at(const kz_atlas *atlas, const line *l, const kz_plane_cycle *at, int axis, bool itself,
                       bool grown, kz_atlas_seeds *seeds) {
  double form, side[2], vector[2];
  if (!kz_curve_form(&atlas->plane, &at->kind.of, at->y, &form, side, vector) || form == 0 || fabs(side[axis]) < FLAT)
    return;
  if (at->kind.of.multiplier > 0)
    explore_fold(atlas, l, &at->kind, at->y, axis, seeds);
  else
    explore_flip(atlas, l, at, axis, itself, grown, seeds);
}

/* Explores a fold of the daughter branch where the normal form at multiplier -1 is 0: beside it, where it is < 0. */
static void explore_degenerate(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  enum { AWAY = 2 };
  kz_plane_cycle at = {.kind = curve->kind};
  const int64_t width = kz_atlas_width(&curve->kind);
  for (int64_t row = 0; row + 1 < curve->n && curve->kind.of.multiplier < 0; row++) {
    const double a = curve->row[row * width + KZ_ROW_FORM], b = curve->row[(row + 1) * width + KZ_ROW_FORM];
    if ((a > 0) == (b > 0)) continue;
    for (int i = 0; i <= AWAY; i += AWAY) {
      const int64_t beside_it = a <= 0 ? row - (a == 0) - i : row + 1 + (b == 0) + i; /* the point may be a row */
      if (beside_it < 0 || beside_it >= curve->n) continue;
      kz_atlas_point_of(curve, beside_it, at.y);
      for (int axis = 0; axis < 2; axis++) explore_at(atlas, NULL, &at, axis, false, true, seeds);
    }
  }
}

static bool is_inside(const double *place) {
  return place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 1;
}

/* The row in the middle of those inside of the rectangle, or of all if none is. */
static int64_t middle_of(const kz_atlas_curve *curve) {
  const int64_t width = kz_atlas_width(&curve->kind);
  int64_t inside = 0, n = 0, row = 0;
  for (int64_t i = 0; i < curve->n; i++) inside += is_inside(curve->row + i * width);
  if (inside == 0) return curve->n / 2;
  for (; row < curve->n; row++)
    if (is_inside(curve->row + row * width) && n++ == inside / 2) break;
  return row;
}

static bool has_image(const kz_atlas *atlas, const kz_atlas_curve *curve, int64_t row) {
  double place[2];
  return kz_atlas_image(atlas, curve->row + row * kz_atlas_width(&curve->kind), place) && is_inside(place);
}

/* The images half a period later of each piece of a curve that has one in the rectangle. */
static void explore_images(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  kz_plane_cycle at = {.kind = curve->kind};
  for (int64_t first = 0, end; first < curve->n && atlas->turned && curve->kind.rest < 0; first = end + 1) {
    for (end = first; end < curve->n && has_image(atlas, curve, end);) end++;
    for (int64_t i = 0; i < IMAGES && end > first; i++) {
      kz_atlas_point_of(curve, first + (2 * i + 1) * (end - first) / (2 * IMAGES), at.y);
      kz_atlas_explore_image(atlas, &at.kind, at.y, seeds);
    }
  }
}

/* The mirror images of a curve where the mirror symmetry is broken: elsewhere they are the curve itself. */
static void explore_mirrored(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  kz_plane_cycle at = {.kind = curve->kind};
  for (int64_t i = 0; i < IMAGES && curve->n > 0 && !kz_atlas_paired(atlas); i++) {
    kz_atlas_point_of(curve, (2 * i + 1) * curve->n / (2 * IMAGES), at.y);
    kz_atlas_explore_mirrored(atlas, &at.kind, at.y, seeds);
  }
}

void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, bool middle, kz_atlas_seeds *seeds) {
  kz_plane_cycle at = {.kind = curve->kind};
  kz_atlas_point_of(curve, middle_of(curve), at.y);
  for (int axis = 0; axis < 2 && middle; axis++) explore_at(atlas, NULL, &at, axis, true, true, seeds);
  explore_images(atlas, curve, seeds);
  explore_mirrored(atlas, curve, seeds);
  explore_degenerate(atlas, curve, seeds);
}

/* Rest along a whole line, which no curve need cross. */
static void follow_rest(const line *l, double value) {
  const double along[2] = {l->axis == 0, l->axis == 1};
  for (int32_t rest = 0; rest < 2 && l->atlas->plane.mirrored; rest++) {
    const kz_cycle_kind kind = {{1, 1, 0, 0, 0}, rest};
    const double start[] = {M_PI * rest, 0, along[1] * value, along[0] * value};
    explore_follow(l->atlas, l, &kind, start, along, 0, l->seeds);
  }
}

void kz_atlas_explore_line(kz_atlas *atlas, int axis, double value, int64_t first, kz_atlas_seeds *seeds,
                           kz_atlas_branches *drawn) {
  line l = {.atlas = atlas, .axis = axis, .seeds = seeds, .drawn = drawn};
  kz_plane_cycle at;
  kz_atlas_crossings_of(atlas, 1 - axis, value, false, &l.crossings);
  KZ_AUTOFREE bool *itself = kz_calloc((size_t)l.crossings.count + 1, 1);
  KZ_AUTOFREE bool *child = kz_calloc((size_t)l.crossings.count + 1, 1);
  l.itself = itself, l.child = child;
  if (drawn) follow_rest(&l, value);
  for (int64_t i = 0; i < l.crossings.count; i++) {
    const kz_atlas_crossing *crossing = l.crossings.list + i;
    const kz_cycle_kind *kind = &atlas->curve[crossing->curve].kind;
    const double share = crossing->at;
    if (crossing->curve < first || share < 0 || share > 1 || (itself[i] && (child[i] || kind->of.multiplier > 0)))
      continue;
    if (kz_atlas_crossing_point(atlas, axis, value, crossing, &at))
      explore_at(atlas, &l, &at, axis, !itself[i], !child[i], seeds);
    itself[i] = child[i] = true;
  }
  kz_atlas_crossings_free(&l.crossings);
}
