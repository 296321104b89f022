/* Where other curves begin: what branches of cycles meet along both axes, and along lines through the whole plane. */
#include "lines.h"
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "branch.h"

/* IMAGES: of a curve, or of a piece of it. */
enum { MOST_ROWS = 500, MOST_EVENTS = 100, IMAGES = 5 };
/* Longest step of a branch, in sides of the plane. */
static const double LONGEST = KZ_ATLAS_BRANCH_STEP;

/* A line through the plane: the curves that cross it, and what of them branches have met already. */
typedef struct {
  kz_atlas *atlas;
  int axis; /* the coordinate that varies */
  kz_atlas_crossings crossings;
  bool *itself, *child; /* [crossings] */
  kz_atlas_seeds *seeds;
  kz_atlas_branches *drawn; /* NULL: the branches are not kept */
} line;

/* Marks the crossing that a branch has met; what is no crossing becomes a seed. `child`: by the branch that begins
 * there. */
static void explore_meet(const line *l, const kz_cycle *seed, bool child) {
  const double at = seed->place[l->axis];
  const int64_t curve = kz_atlas_known(l->atlas, seed);
  int64_t nearest = -1;
  for (int64_t i = 0; i < l->crossings.count && curve >= 0; i++)
    if (l->crossings.list[i].curve == curve &&
        (nearest < 0 || fabs(l->crossings.list[i].at - at) < fabs(l->crossings.list[nearest].at - at)))
      nearest = i;
  if (nearest >= 0)
    (child ? l->child : l->itself)[nearest] = true;
  else if (curve < 0)
    kz_atlas_add(l->atlas, seed, l->seeds);
}

/* Takes what a branch has met: to a line, or as a seed. */
static void explore_take(const kz_atlas *atlas, const line *l, const kz_cycle *cycle, bool child,
                         kz_atlas_seeds *seeds) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds one = {0};
  if (kz_atlas_add(atlas, cycle, l ? &one : seeds) && l) explore_meet(l, one.list, child);
}

/* Follows a cycle along a line and adds what it meets: points of curves, and the cycles that branches grow out of. */
static void follow_to(const kz_atlas *atlas, const line *l, const kz_cycle *start, const kz_branch_way *way,
                      kz_atlas_seeds *seeds) {
  KZ_AUTOFREE kz_cycle *row = kz_malloc(MOST_ROWS * sizeof *row), *event = kz_malloc(MOST_EVENTS * sizeof *event);
  kz_branch_end end;
  if (kz_kind_period(&start->kind) > atlas->scene->atlas->max_period) return;
  kz_cycle_continue(&atlas->plane, start, way, row, event, &end);
  if (l && l->drawn) kz_atlas_draw(atlas, l->axis, row, event, &end, l->drawn);
  for (kz_cycle *at = event; at < event + end.events; at++) {
    kz_cycle parent;
    if (at->event <= KZ_EVENT_FLIP) {
      at->kind.multiplier = at->event == KZ_EVENT_FOLD ? 1 : -1;
      explore_take(atlas, l, at, false, seeds);
    } else if (kz_cycle_parent(&atlas->plane, at, &parent) && kz_cycle_locate(&atlas->plane, &parent, way->along)) {
      explore_take(atlas, l, &parent, true, seeds);
    }
  }
}

static void explore_follow(const kz_atlas *atlas, const line *l, const kz_cycle *start, const double along[2],
                           int32_t side, kz_atlas_seeds *seeds) {
  follow_to(atlas, l, start, &(kz_branch_way){{along[0], along[1]}, LONGEST, 0, MOST_ROWS, MOST_EVENTS, side}, seeds);
}

void kz_atlas_explore_first(const kz_atlas *atlas, const kz_cycle *cycle, kz_atlas_seeds *seeds) {
  static const double along[][2] = {{0, -1}, {0, 1}, {-1, 0}, {1, 0}};
  const int64_t before = seeds->count;
  for (int i = 0; i < 4 && seeds->count == before; i++) {
    const kz_branch_way way = {
        .along = {along[i][0], along[i][1]}, .longest = LONGEST, .most = MOST_ROWS, .most_events = 1};
    follow_to(atlas, NULL, cycle, &way, seeds);
  }
}

bool kz_atlas_grown(const kz_atlas *atlas, const kz_cycle *flip, int axis, kz_cycle *child, double along[2]) {
  const kz_cycle_kind kind = kz_child_kind(&flip->kind);
  return kz_kind_period(&kind) <= atlas->scene->atlas->max_period &&
         kz_cycle_child(&atlas->plane, flip, axis, child, along);
}

/* The cycle to both sides along an axis, if `itself`, and what branches off, if `computed`. */
static void explore_flip(const kz_atlas *atlas, const line *l, const kz_cycle *flip, int axis, bool itself, bool grown,
                         kz_atlas_seeds *seeds) {
  double along[2] = {0};
  kz_cycle child;
  for (int sign = -1; sign <= 1 && itself; sign += 2) {
    along[axis] = sign;
    explore_follow(atlas, l, flip, along, 0, seeds);
  }
  if (grown && kz_atlas_grown(atlas, flip, axis, &child, along)) explore_follow(atlas, l, &child, along, 0, seeds);
}

/* Everything that branches off a point of a curve along an axis: both branches of a fold, or a cycle and its child. */
static void explore_at(const kz_atlas *atlas, const line *l, const kz_cycle *at, int axis, bool itself, bool grown,
                       kz_atlas_seeds *seeds) {
  const double along[2] = {axis == 0, axis == 1};
  kz_normal_form form;
  if (!kz_cycle_form(&atlas->plane, at, &form) || form.coefficient == 0 || fabs(form.side[axis]) < KZ_CHILD_FLAT)
    return;
  if (at->kind.multiplier < 0) explore_flip(atlas, l, at, axis, itself, grown, seeds);
  for (int side = -1; side <= 1 && at->kind.multiplier > 0; side += 2) explore_follow(atlas, l, at, along, side, seeds);
}

/* Explores a fold of the daughter branch where the normal form at multiplier -1 is 0: beside it, where it is < 0. */
static void explore_degenerate(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  enum { AWAY = 2 };
  for (int64_t row = 0; row + 1 < curve->n && curve->kind.multiplier < 0; row++) {
    const double a = curve->row[row].form.coefficient, b = curve->row[row + 1].form.coefficient;
    if ((a > 0) == (b > 0)) continue;
    for (int i = 0; i <= AWAY; i += AWAY) {
      const int64_t beside_it = a <= 0 ? row - (a == 0) - i : row + 1 + (b == 0) + i; /* the point may be a row */
      if (beside_it < 0 || beside_it >= curve->n) continue;
      for (int axis = 0; axis < 2; axis++) explore_at(atlas, NULL, &curve->row[beside_it].at, axis, false, true, seeds);
    }
  }
}

static bool is_inside(const double *place) {
  return place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 1;
}

/* The row in the middle of those inside of the rectangle, or of all if none is. */
static int64_t middle_of(const kz_atlas_curve *curve) {
  int64_t inside = 0, n = 0, row = 0;
  for (int64_t i = 0; i < curve->n; i++) inside += is_inside(curve->row[i].at.place);
  if (inside == 0) return curve->n / 2;
  for (; row < curve->n; row++)
    if (is_inside(curve->row[row].at.place) && n++ == inside / 2) break;
  return row;
}

/* The images half a period later of each piece of a curve that has one in the rectangle. */
static void explore_images(const kz_atlas *atlas, const kz_atlas_curve *curve, kz_atlas_seeds *seeds) {
  double image[2];
  for (int64_t first = 0, end; first < curve->n && atlas->turned && !curve->kind.rest; first = end + 1) {
    for (end = first; end < curve->n && kz_atlas_image(atlas, curve->row[end].at.place, image) && is_inside(image);)
      end++;
    for (int64_t i = 0; i < IMAGES && end > first; i++)
      kz_atlas_explore_image(atlas, &curve->row[first + (2 * i + 1) * (end - first) / (2 * IMAGES)].at, seeds);
  }
}

void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, bool middle, kz_atlas_seeds *seeds) {
  for (int axis = 0; axis < 2 && middle; axis++)
    explore_at(atlas, NULL, &curve->row[middle_of(curve)].at, axis, true, true, seeds);
  explore_images(atlas, curve, seeds);
  /* Mirror images of a curve where the mirror symmetry is broken: elsewhere they are the curve itself */
  for (int64_t i = 0; i < IMAGES && curve->n > 0 && !kz_atlas_paired(atlas); i++)
    kz_atlas_explore_mirrored(atlas, &curve->row[(2 * i + 1) * curve->n / (2 * IMAGES)].at, seeds);
  explore_degenerate(atlas, curve, seeds);
}

/* Rest along a whole line, which no curve need cross. */
static void follow_rest(const line *l, double value) {
  const double along[2] = {l->axis == 0, l->axis == 1};
  for (int32_t rest = 1; rest <= 2 && l->atlas->plane.mirrored; rest++) {
    kz_cycle start = {.kind = {.side = 1, .points = 1, .rest = rest}, .place = {along[1] * value, along[0] * value}};
    start.point[0][0] = kz_kind_rest(&start.kind);
    explore_follow(l->atlas, l, &start, along, 0, l->seeds);
  }
}

void kz_atlas_explore_line(kz_atlas *atlas, int axis, double value, int64_t first, kz_atlas_seeds *seeds,
                           kz_atlas_branches *drawn) {
  line l = {.atlas = atlas, .axis = axis, .seeds = seeds, .drawn = drawn};
  kz_cycle at;
  kz_atlas_crossings_of(atlas, 1 - axis, value, false, &l.crossings);
  KZ_AUTOFREE bool *itself = kz_calloc((size_t)l.crossings.count + 1, 1);
  KZ_AUTOFREE bool *child = kz_calloc((size_t)l.crossings.count + 1, 1);
  l.itself = itself, l.child = child;
  if (drawn) follow_rest(&l, value);
  for (int64_t i = 0; i < l.crossings.count; i++) {
    const kz_atlas_crossing *crossing = l.crossings.list + i;
    const kz_cycle_kind *kind = &atlas->curve[crossing->curve].kind;
    const double share = crossing->at;
    if (crossing->curve < first || share < 0 || share > 1 || (itself[i] && (child[i] || kind->multiplier > 0)))
      continue;
    if (kz_atlas_crossing_point(atlas, axis, value, crossing, &at))
      explore_at(atlas, &l, &at, axis, !itself[i], !child[i], seeds);
    itself[i] = child[i] = true;
  }
  kz_atlas_crossings_free(&l.crossings);
}
