/* Catalogues of neighbouring values joined into branches. Every attractor of a value is carried to the next one by continuation;
 * where it arrives, it is the same branch, whether the search there had found it or not. What no lower value leads to is
 * carried back to where it began. Rounds of walks, spread over the run, until nothing is left to walk. */
#include <math.h>
#include <stdlib.h>

#include "sweep.h"

/* A walk from a node to the neighbour value, and its result. */
typedef struct {
  int64_t node;
  int32_t forward;
} task;

typedef struct {
  double last; /* value reached */
  int32_t arrived, kind;
  kz_branch_point point;
} outcome;

typedef struct {
  const kz_scene *scene;
  kz_sweep_branches *branches;
  const task *tasks;
} walking;

void kz_sweep_branches_free(kz_sweep_branches *branches) {
  free(branches->nodes);
  free(branches->first_node);
  *branches = (kz_sweep_branches){0};
}

static void add_node(kz_sweep_branches *branches, const kz_sweep_entry *entry, int64_t value) {
  if (branches->n_nodes == branches->capacity) {
    const int64_t capacity = 2 * branches->capacity + 64;
    branches->nodes = kz_realloc(branches->nodes, (size_t)capacity * sizeof *branches->nodes);
    branches->capacity = capacity;
  }
  branches->nodes[branches->n_nodes++] = (kz_sweep_node){.entry = *entry,
                                                         .value = value,
                                                         .previous = -1,
                                                         .next = -1,
                                                         .first = NAN,
                                                         .last = NAN,
                                                         .first_kind = KZ_END_NOT_LOCATED,
                                                         .last_kind = KZ_END_NOT_LOCATED};
}

/* The value to which a walk leads. */
static int64_t aim(const walking *w, const task *t) {
  return w->branches->nodes[t->node].value + (t->forward ? 1 : -1);
}

static kz_status walk_tile(void *context, int64_t tile, void *record) {
  const walking *w = context;
  const task *t = w->tasks + tile;
  const kz_sweep_node *node = w->branches->nodes + t->node;
  const kz_sweep_plan *plan = w->scene->sweep;
  const kz_path path = kz_sweep_path(w->scene);
  outcome *out = record;
  const double to = kz_sweep_value(plan, aim(w, t));
  out->point = node->entry.point;
  out->last = kz_walk(&path, kz_sweep_value(plan, node->value), to, &out->point);
  out->arrived = out->last == to;
  if (out->arrived) return KZ_OK;
  out->kind = kz_end_kind(&out->point);
  out->last = kz_locate_end(&path, out->last, &out->point, out->kind);
  return KZ_OK;
}

/* The node of a value that is this very cycle; -1 where there is none. */
static int64_t find_node(const walking *w, int64_t value, const kz_branch_point *point) {
  kz_pendulum pendulum;
  if (!kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, value), &pendulum)) return -1;
  for (int64_t i = 0; i < w->branches->n_nodes; i++) {
    const kz_sweep_node *node = w->branches->nodes + i;
    if (node->value == value && node->entry.point.period > 0 && kz_branch_same(&pendulum, &node->entry.point, point)) return i;
  }
  return -1;
}

static void set_end(kz_sweep_node *node, bool forward, double last, int32_t kind) {
  *(forward ? &node->last : &node->first) = last;
  *(forward ? &node->last_kind : &node->first_kind) = kind;
}

/* Joins the node of a walk to where it arrived. */
static void join(const walking *w, const task *t, const outcome *out) {
  kz_sweep_branches *b = w->branches;
  if (!out->arrived) {
    set_end(b->nodes + t->node, t->forward, out->last, out->kind);
    return;
  }
  int64_t there = find_node(w, aim(w, t), &out->point);
  if (there < 0) {
    there = b->n_nodes;
    add_node(b, &(kz_sweep_entry){.point = out->point}, aim(w, t));
  }
  int64_t *back = t->forward ? &b->nodes[there].previous : &b->nodes[there].next;
  if (*back >= 0) return; /* another cycle has arrived there before */
  *back = t->node;
  *(t->forward ? &b->nodes[t->node].next : &b->nodes[t->node].previous) = there;
}

/* The cycles from node `first` on that have no neighbour in the direction of the walk, the ends of the range left out. */
static int64_t list_tasks(const walking *w, bool forward, int64_t first, task *tasks) {
  const int64_t edge = forward ? w->scene->sweep->values.count - 1 : 0;
  int64_t n = 0;
  for (int64_t i = first; i < w->branches->n_nodes; i++) {
    const kz_sweep_node *node = w->branches->nodes + i;
    if (node->entry.point.period == 0 || node->value == edge || (forward ? node->next : node->previous) >= 0) continue;
    tasks[n++] = (task){i, forward};
  }
  return n;
}

/* Rounds of walks: those of a round start at the nodes that the round before has added. */
static kz_status walk_all(walking *w, const kz_run *run, bool forward) {
  KZ_FREED task *tasks = kz_malloc((size_t)(w->branches->n_nodes + 1) * sizeof *tasks);
  KZ_FREED outcome *outcomes = kz_malloc((size_t)(w->branches->n_nodes + 1) * sizeof *outcomes);
  w->tasks = tasks;
  for (int64_t n = list_tasks(w, forward, 0, tasks); n > 0;) {
    const kz_stage stage = kz_stage_for_all("sweep branches", n, sizeof *outcomes, walk_tile, w);
    const int64_t known = w->branches->n_nodes;
    KZ_TRY(kz_stage_run(run, &stage, outcomes));
    for (int64_t i = 0; i < n; i++) join(w, tasks + i, outcomes + i);
    n = kz_sampling_weight(run) == 1 ? list_tasks(w, forward, known, tasks) : 0; /* a sample knows few values */
  }
  return KZ_OK;
}

/* The distance between two chaotic attractors, by their mean angles and velocities (point.theta, point.velocity). */
static double unlike(const kz_branch_point *a, const kz_branch_point *b) {
  return fabs(remainder(a->theta - b->theta, 2 * M_PI)) + fabs(a->velocity - b->velocity);
}

/* Chaotic attractors have no cycle that continuation could carry: each joins the nearest one of the next value. */
static void join_chaotic(kz_sweep_branches *b) {
  for (int64_t i = 0; i < b->n_nodes; i++) {
    int64_t best = -1;
    for (int64_t j = 0; b->nodes[i].entry.point.period == 0 && j < b->n_nodes; j++) {
      const kz_sweep_node *other = b->nodes + j;
      if (other->entry.point.period != 0 || other->value != b->nodes[i].value + 1 || other->previous >= 0) continue;
      if (best < 0 ||
          unlike(&b->nodes[i].entry.point, &other->entry.point) < unlike(&b->nodes[i].entry.point, &b->nodes[best].entry.point))
        best = j;
    }
    if (best < 0) continue;
    b->nodes[i].next = best;
    b->nodes[best].previous = i;
  }
}

/* By centre, period (chaotic last), |winding|/period, + first, the value where it begins, first strobe velocity and angle. */
static bool before(const kz_sweep_node *a, const kz_sweep_node *b) {
  const kz_branch_point *p = &a->entry.point, *q = &b->entry.point;
  const double keys[][2] = {{p->centre, q->centre},
                            {p->period > 0 ? p->period : INFINITY, q->period > 0 ? q->period : INFINITY},
                            {abs(p->winding) / fmax(p->period, 1), abs(q->winding) / fmax(q->period, 1)},
                            {-p->winding, -q->winding},
                            {(double)a->value, (double)b->value},
                            {p->velocity, q->velocity},
                            {p->theta, q->theta}};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (keys[i][0] != keys[i][1]) return keys[i][0] < keys[i][1];
  return false;
}

static void list_branches(kz_sweep_branches *b) {
  b->first_node = kz_malloc((size_t)(b->n_nodes + 1) * sizeof *b->first_node);
  for (int64_t i = 0; i < b->n_nodes; i++) {
    if (b->nodes[i].previous >= 0) continue;
    int64_t j = b->n_branches++;
    for (; j > 0 && before(b->nodes + i, b->nodes + b->first_node[j - 1]); j--) b->first_node[j] = b->first_node[j - 1];
    b->first_node[j] = i;
  }
}

/* Where no walk has found its ends, a branch begins and ends at the values where it is seen; at the edges it leaves the range. */
static void set_known_ends(const kz_scene *scene, kz_sweep_branches *b) {
  for (int64_t i = 0; i < b->n_nodes; i++) {
    kz_sweep_node *node = b->nodes + i;
    const double value = kz_sweep_value(scene->sweep, node->value);
    if (node->value == 0)
      set_end(node, false, value, KZ_END_OF_RANGE);
    else if (isnan(node->first))
      node->first = value;
    if (node->value == scene->sweep->values.count - 1)
      set_end(node, true, value, KZ_END_OF_RANGE);
    else if (isnan(node->last))
      node->last = value;
  }
}

kz_status kz_sweep_branches_make(const kz_scene *scene, const kz_run *run, const kz_sweep_catalogue *catalogue,
                                 kz_sweep_branches *branches) {
  walking w = {.scene = scene, .branches = branches};
  for (int64_t i = 0; i < scene->sweep->values.count; i++)
    for (int64_t j = 0; j < catalogue[i].count; j++) add_node(branches, catalogue[i].entries + j, i);
  KZ_TRY(walk_all(&w, run, true));
  KZ_TRY(walk_all(&w, run, false));
  join_chaotic(branches);
  set_known_ends(scene, branches);
  list_branches(branches);
  return KZ_OK;
}
