/* Motions of a point: listed by counting crossings of its column; states carried from where they begin or end. */
#include "lines.h"
#include "cycles.h"
#include "seeds.h"
#include "branch.h"
#include "motions.h"
#include "probe.h"

enum { MOST_ROWS = 400, STARTS = 512 };
/* rad: two cycles nearer than this are one. */
static const double ONE = 1e-6;

/* A place, one class of its attractors, and those that are known by now. */
typedef struct {
  kz_atlas *atlas;
  const double *place;
  kz_atlas_class class;
  int32_t wanted, found;
  kz_cycle *cycle; /* [found] */
  int64_t *curve;  /* [found] */
} hunt;

static bool motions_attracts(const kz_cycle *cycle) {
  return fabs(cycle->number[0]) < 1 + cycle->number[1];
}

static void motions_take(hunt *h, const kz_cycle *cycle, int64_t curve) {
  if (kz_atlas_has(h->atlas, h->found, h->cycle, cycle, ONE)) return;
  h->cycle[h->found] = *cycle;
  h->curve[h->found++] = curve;
}

/* Follows a cycle along an axis to the place; true if it attracts on all of the way. side: 1 or -1: one of the branches
 * of a fold. */
static bool motions_carry(const hunt *h, int axis, const kz_cycle *from, int32_t side, kz_cycle *to) {
  const double target = h->place[axis], sign = target > from->place[axis] ? 1 : -1;
  const kz_branch_way way = {{axis == 0 ? sign : 0, axis == 1 ? sign : 0}, KZ_ATLAS_BRANCH_STEP, 0, MOST_ROWS, 0, side};
  KZ_AUTOFREE kz_cycle *row = kz_malloc(MOST_ROWS * sizeof *row);
  kz_plane plane = h->atlas->plane;
  kz_branch_end end;
  *(sign > 0 ? plane.high + axis : plane.low + axis) = target;
  kz_cycle_continue(&plane, from, &way, row, NULL, &end);
  if (end.rows < 2 || end.ending != KZ_TRACE_LEFT) return false;
  for (int64_t i = 1; i + 1 < end.rows; i++)
    if (!motions_attracts(row + i)) return false;
  const kz_cycle *a = row + end.rows - 2, *b = row + end.rows - 1;
  const double share = (target - a->place[axis]) / (b->place[axis] - a->place[axis]);
  if (!(share >= 0 && share <= 1)) return false; /* it has left on the other side */
  *to = *a;
  for (int i = 0; i < to->kind.points; i++)
    for (int c = 0; c < 2; c++) to->point[i][c] = a->point[i][c] + share * (b->point[i][c] - a->point[i][c]);
  memcpy(to->place, h->place, sizeof to->place);
  return kz_cycle_solve(&h->atlas->plane, to) && motions_attracts(to);
}

/* Carries from a crossing the cycle born on the place's side: a fold's stable branch, its own or a daughter cycle. */
static void carry_from(hunt *h, int axis, const kz_atlas_crossing *crossing) {
  const kz_atlas_curve *curve = h->atlas->curve + crossing->curve;
  const bool is_own = kz_atlas_is_of(&curve->kind, &h->class);
  kz_cycle from, child, to;
  double along[2];
  if (!kz_atlas_crossing_point(h->atlas, axis, h->place[1 - axis], crossing, &from)) return;
  if (!is_own && !kz_atlas_grown(h->atlas, &from, axis, &child, along)) return;
  const bool is_fold = is_own && curve->kind.multiplier > 0;
  for (int32_t side = is_fold ? -1 : 0; side <= (is_fold ? 1 : 0); side += 2)
    if (motions_carry(h, axis, is_own ? &from : &child, side, &to)) motions_take(h, &to, crossing->curve);
}

/* Carries from the nearest crossings of a line through the place that give the class an attractor on the way. */
static void hunt_along(hunt *h, int axis) {
  KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings crossings = {0};
  const int32_t number = kz_atlas_class_number(h->atlas, &h->class);
  kz_atlas_crossings_of(h->atlas, 1 - axis, h->place[1 - axis], true, &crossings);
  int64_t above = 0;
  while (above < crossings.count && crossings.list[above].at <= h->place[axis]) above++;
  for (int64_t down = above - 1; h->found < h->wanted && (down >= 0 || above < crossings.count);) {
    const double below_by = down >= 0 ? h->place[axis] - crossings.list[down].at : INFINITY;
    const double above_by = above < crossings.count ? crossings.list[above].at - h->place[axis] : INFINITY;
    const kz_atlas_crossing *next = crossings.list + (below_by <= above_by ? down : above);
    if (next->class == number && next->change == (below_by <= above_by ? 1 : -1)) carry_from(h, axis, next);
    below_by <= above_by ? down-- : above++;
  }
}

/* Attractors of the place that starts have found. */
static void hunt_among(hunt *h, const kz_atlas_seeds *known) {
  for (int64_t i = 0; i < known->count && h->found < h->wanted; i++) {
    kz_cycle cycle = known->list[i];
    if (kz_atlas_is_of(&cycle.kind, &h->class) && kz_cycle_solve(&h->atlas->plane, &cycle)) motions_take(h, &cycle, -1);
  }
}

/* Attractors that no curve bounds are searched. */
static void hunt_by_starts(hunt *h) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds found = {0};
  if (kz_atlas_probe_at(h->atlas, h->place, STARTS, 1, &found) == KZ_OK) hunt_among(h, &found);
}

static void hunt_rest(hunt *h) {
  kz_cycle rest = {.kind = {.side = 1, .points = 1, .rest = 1 + h->class.turns}, .place = {h->place[0], h->place[1]}};
  rest.point[0][0] = kz_kind_rest(&rest.kind);
  if (kz_cycle_solve(&h->atlas->plane, &rest) && motions_attracts(&rest)) motions_take(h, &rest, -1);
}

static void set_state(const hunt *h, int32_t i, kz_motion *motion) {
  double point[2 * KZ_CURVE_POINTS][2];
  motion->curve = h->curve[i];
  motion->strobes = kz_atlas_points(h->atlas, h->cycle + i, point);
  for (int32_t s = 0; s < motion->strobes; s++) {
    motion->theta[s] = remainder(point[s][0], 2 * M_PI);
    motion->velocity[s] = point[s][1];
  }
  kz_atlas_multipliers(h->cycle + i, motion->multiplier_re, motion->multiplier_im);
}

/* The states of all attractors of a class at a place: to `motion`, if not NULL. known: attractors that starts have
 * found there; NULL: starts are followed if need be. Returns how many were found. */
static int32_t set_states(kz_atlas *atlas, const double place[2], const kz_atlas_class *class, int32_t wanted,
                          const kz_atlas_seeds *known, kz_motion *motion) {
  enum { CARRIED_AT_ONCE = 2 }; /* both branches of a fold may attract where both are carried */
  KZ_AUTOFREE kz_cycle *cycle = kz_malloc((size_t)(wanted + CARRIED_AT_ONCE) * sizeof *cycle);
  KZ_AUTOFREE int64_t *curve = kz_malloc((size_t)(wanted + CARRIED_AT_ONCE) * sizeof *curve);
  hunt h = {.atlas = atlas, .place = place, .class = *class, .wanted = wanted, .cycle = cycle, .curve = curve};
  const bool rest = class->symmetric && class->period == 1 && atlas->plane.mirrored;
  if (rest) hunt_rest(&h);
  for (int axis = 1; axis >= 0 && h.found < wanted && !rest; axis--) hunt_along(&h, axis);
  if (h.found < wanted && known) hunt_among(&h, known);
  if (h.found < wanted && !known) hunt_by_starts(&h);
  for (int32_t i = 0; i < h.found && i < wanted && motion; i++) set_state(&h, i, motion + i);
  return h.found < wanted ? h.found : wanted;
}

void kz_atlas_confirm(kz_atlas *atlas, const double place[2], const kz_atlas_seeds *known, int64_t *listed,
                      int64_t *unsolved) {
  KZ_AUTOFREE int32_t *counts = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  *listed = *unsolved = 0;
  kz_atlas_count(atlas, place, counts);
  if (!kz_atlas_plausible(atlas, counts)) return;
  for (int32_t c = 0; c < atlas->n_classes; c++) {
    if (counts[c] == 0) continue;
    *listed += counts[c];
    *unsolved += counts[c] - set_states(atlas, place, atlas->class + c, counts[c], known, NULL);
  }
}

kz_status kz_atlas_motions(kz_atlas *atlas, double x, double y, bool states, kz_motions *motions) {
  const double value[2] = {x, y};
  double place[2];
  *motions = (kz_motions){.x = x, .y = y};
  for (int i = 0; i < 2; i++) KZ_TRY(kz_atlas_place(atlas, i, value[i], place + kz_atlas_axis(atlas, i)));
  KZ_AUTOFREE int32_t *counts = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  kz_atlas_pendulum(atlas->scene, place, &motions->pendulum);
  kz_atlas_count(atlas, place, counts);
  motions->known = kz_atlas_plausible(atlas, counts);
  for (int32_t c = 0; c < atlas->n_classes && motions->known; c++) {
    const kz_atlas_class *class = atlas->class + c;
    if (counts[c] <= 0) continue;
    motions->motion = kz_realloc(motions->motion, (size_t)(motions->count + counts[c]) * sizeof *motions->motion);
    kz_motion *first = motions->motion + motions->count;
    for (int32_t i = 0; i < counts[c]; i++) first[i] = (kz_motion){.of = kz_atlas_described(atlas, class), .curve = -1};
    motions->count += counts[c];
    if (states) set_states(atlas, place, class, counts[c], NULL, first);
  }
  return KZ_OK;
}

void kz_motions_free(kz_motions *motions) {
  free(motions->motion);
  *motions = (kz_motions){0};
}
