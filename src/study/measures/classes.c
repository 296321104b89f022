/* Attractors of neighbouring points joined by continuation. */
#include "points.h"

enum { RIGHT, ABOVE, WAYS };

/* Where the attractors of a point go: to[way][place] = the place in the list of the neighbour; -1 = to none of it. */
typedef struct {
  int8_t to[WAYS][KZ_POINT_MOST];
} neighbours;

typedef struct {
  const kz_points *points;
  const void *records;
} joining;

typedef struct {
  const kz_points *points;
  int64_t from, to;
  kz_fine_maps *maps;
} step;

static bool on_the_way(const void *context, double value, kz_pendulum *pendulum) {
  const step *s = context;
  return kz_points_pendulum(s->points, s->from, s->to, value, pendulum);
}

/* The cycle of `there` in which one of the point `from` arrives; -1 = none. */
static int8_t classes_carry(const step *s, const kz_attractor *cycle, const kz_measured_point *there) {
  const kz_path path = {.pendulum = on_the_way, .context = s, .to = 1, .maps = s->maps};
  kz_sweep_walk walk;
  kz_pendulum pendulum;
  bool possible = false;
  for (int64_t i = 0; i < there->count; i++) possible = possible || kz_branch_alike(there->attractor + i, cycle);
  if (!possible || !kz_points_pendulum(s->points, s->to, s->to, 0, &pendulum)) return -1;
  kz_sweep_follow(&path, 0, cycle, 0, &walk);
  for (int64_t i = 0; i < there->count && walk.piece->reached == 1; i++)
    if (there->attractor[i].period > 0 && kz_branch_same(s->maps, &pendulum, there->attractor + i, &walk.piece->point))
      return (int8_t)i;
  return -1;
}

/* The attractor of `there` nearest to one that never closes, of its kind; -1 = none. */
static int8_t classes_nearest(const kz_attractor *one, const kz_measured_point *there) {
  int8_t best = -1;
  for (int64_t i = 0; i < there->count; i++)
    if (kz_branch_alike(one, there->attractor + i) &&
        (best < 0 ||
         kz_branch_points_apart(one, there->attractor + i) < kz_branch_points_apart(one, there->attractor + best)))
      best = (int8_t)i;
  return best;
}

static kz_status join_tile(void *context, int64_t tile, void *record) {
  const joining *j = context;
  const kz_points *points = j->points;
  neighbours *out = record;
  const kz_measured_point *here = kz_point_at(points, j->records, tile);
  const bool has[] = {tile % points->columns + 1 < points->columns, tile / points->columns + 1 < points->rows};
  const int64_t at[] = {tile + 1, tile + points->columns};
  kz_fine_maps *maps = kz_fine_maps_create(3); /* maps of the point and its neighbours */
  for (int way = 0; way < WAYS; way++)
    for (int64_t place = 0; place < KZ_POINT_MOST; place++) {
      out->to[way][place] = -1;
      if (!has[way] || place >= here->count) continue;
      const step s = {points, tile, at[way], maps};
      const kz_measured_point *there = kz_point_at(points, j->records, at[way]);
      const kz_attractor *one = here->attractor + place;
      out->to[way][place] = one->period > 0 ? classes_carry(&s, one, there) : classes_nearest(one, there);
    }
  kz_fine_maps_free(maps);
  return KZ_OK;
}

/* The root of a tree of places, whose way becomes shorter. */
static int64_t classes_root(int64_t *parent, int64_t place) {
  while (parent[place] != place) place = parent[place] = parent[parent[place]];
  return place;
}

/* Classes grow point by point; the places of each form a list, in order, from its root on. */
typedef struct {
  int64_t *parent, *next, *last; /* [places]; next -1 = the end; last: of a root */
} forest;

/* Whether a point is in both lists. */
static bool classes_meet(const forest *f, int64_t i, int64_t j) {
  while (i >= 0 && j >= 0) {
    if (i / KZ_POINT_MOST == j / KZ_POINT_MOST) return true;
    if (i < j)
      i = f->next[i];
    else
      j = f->next[j];
  }
  return false;
}

/* Joins the classes of two places unless a point would have both. */
static void classes_join(forest *f, int64_t a, int64_t b) {
  int64_t i = classes_root(f->parent, a), j = classes_root(f->parent, b), *link = NULL;
  const int64_t head = kz_smaller(i, j), tail = kz_larger(i, j);
  if (i == j) return;
  if (tail > f->last[head]) { /* as nearly always: the next point */
    if (tail / KZ_POINT_MOST == f->last[head] / KZ_POINT_MOST) return;
    f->next[f->last[head]] = tail;
  } else {
    if (classes_meet(f, i, j)) return;
    while (i >= 0 || j >= 0) {
      int64_t *const from = j < 0 || (i >= 0 && i < j) ? &i : &j;
      if (link) *link = *from;
      link = f->next + *from;
      *from = *link;
    }
  }
  f->parent[tail] = head;
  if (f->last[tail] > f->last[head]) f->last[head] = f->last[tail];
}

/* Numbers the trees in the order of the catalogue of the points where they begin. */
static void number_classes(const joining *j, int64_t places, forest *f, kz_classes *classes) {
  classes->of = kz_malloc((size_t)places * sizeof *classes->of);
  classes->first_point = kz_malloc((size_t)(places + 1) * sizeof *classes->first_point);
  classes->first_place = kz_malloc((size_t)(places + 1) * sizeof *classes->first_place);
  for (int64_t i = 0; i < places; i++) {
    const int64_t point = i / KZ_POINT_MOST, place = i % KZ_POINT_MOST;
    const kz_measured_point *at = kz_point_at(j->points, j->records, point);
    if (place >= at->count || f->parent[i] != i) continue;
    int64_t k = classes->count++;
    for (; k > 0; k--) {
      const kz_measured_point *other = kz_point_at(j->points, j->records, classes->first_point[k - 1]);
      if (kz_branch_points_order(at->attractor + place, other->attractor + classes->first_place[k - 1]) >= 0) break;
      classes->first_point[k] = classes->first_point[k - 1];
      classes->first_place[k] = classes->first_place[k - 1];
    }
    classes->first_point[k] = point;
    classes->first_place[k] = (int32_t)place;
  }
  for (int64_t k = 0; k < classes->count; k++)
    for (int64_t i = classes->first_point[k] * KZ_POINT_MOST + classes->first_place[k]; i >= 0; i = f->next[i])
      classes->of[i] = (int32_t)k;
}

/* Joins the places of a point to those of a neighbour before it that arrive there. */
static void join_point(forest *f, const kz_measured_point *before_it, int64_t point, int64_t from, const int8_t *to) {
  for (int64_t place = 0; place < before_it->count; place++)
    if (to[place] >= 0) classes_join(f, from * KZ_POINT_MOST + place, point * KZ_POINT_MOST + to[place]);
}

static void classes_grow(const joining *j, const neighbours *to, kz_classes *classes) {
  const int64_t columns = j->points->columns, points = columns * j->points->rows, places = points * KZ_POINT_MOST;
  KZ_AUTOFREE int64_t *parent = kz_malloc((size_t)places * sizeof *parent),
                      *next = kz_malloc((size_t)places * sizeof *next),
                      *last = kz_malloc((size_t)places * sizeof *last);
  forest f = {parent, next, last};
  for (int64_t i = 0; i < places; i++) {
    parent[i] = last[i] = i;
    next[i] = -1;
  }
  for (int64_t point = 0; point < points; point++) {
    const int64_t from[] = {point % columns > 0 ? point - 1 : -1, point - columns};
    for (int way = 0; way < WAYS; way++)
      if (from[way] >= 0)
        join_point(&f, kz_point_at(j->points, j->records, from[way]), point, from[way], to[from[way]].to[way]);
  }
  number_classes(j, places, &f, classes);
}

void kz_classes_free(kz_classes *classes) {
  free(classes->of);
  free(classes->first_point);
  free(classes->first_place);
  *classes = (kz_classes){0};
}

kz_status kz_classes_make(const kz_points *points, const kz_run *run, const void *records, kz_classes *classes) {
  joining j = {points, records};
  kz_stage stage = kz_stage_for_rank0("neighbours", points->columns * points->rows, sizeof(neighbours), join_tile, &j);
  const bool here = kz_rank(run->ranks) == 0;
  KZ_AUTOFREE neighbours *to = here ? kz_malloc((size_t)stage.n_tiles * sizeof *to) : NULL;
  KZ_TRY(kz_stage_run(run, &stage, to));
  if (here) classes_grow(&j, to, classes);
  return KZ_OK;
}
