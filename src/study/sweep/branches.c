/* Catalogues of neighbouring values joined into branches. Every cycle of a value is followed to the next one,
 * attracting or not, through folds, with what branches off; where it arrives, it is the same branch, whether the search
 * there had found it or not. Rounds of walks, spread over the run, until nothing is left to walk. */
#include "sweep.h"

enum { MOST_MAPS = 256 }; /* largest number of values whose maps are kept, 50 KiB each */

/* A walk from a node to the neighbour value. */
typedef struct {
  int64_t node;
  int32_t forward;
} task;

typedef struct {
  const kz_scene *scene;
  kz_sweep_branches *branches;
  const task *tasks;
} walking;

void kz_sweep_branches_free(kz_sweep_branches *branches) {
  free(branches->nodes);
  free(branches->first_node);
  kz_fine_maps_free(branches->maps);
  *branches = (kz_sweep_branches){0};
}

static int64_t add_node(kz_sweep_branches *branches, const kz_sweep_entry *entry, int64_t value, bool attracts) {
  branches->nodes =
      kz_list_reserve(branches->nodes, &branches->nodes_capacity, branches->n_nodes + 1, sizeof *branches->nodes);
  branches->nodes[branches->n_nodes++] = (kz_sweep_node){.entry = *entry,
                                                         .value = value,
                                                         .attracts = attracts,
                                                         .previous = -1,
                                                         .next = -1,
                                                         .first = NAN,
                                                         .last = NAN,
                                                         .first_kind = KZ_END_NOT_LOCATED,
                                                         .last_kind = KZ_END_NOT_LOCATED};
  return branches->n_nodes - 1;
}

/* The value to which a walk leads. */
static int64_t branches_aim(const walking *w, const task *t) {
  return w->branches->nodes[t->node].value + (t->forward ? 1 : -1);
}

static kz_status walk_tile(void *context, int64_t tile, void *record) {
  const walking *w = context;
  const task *t = w->tasks + tile;
  const kz_sweep_node *node = w->branches->nodes + t->node;
  const kz_path path = kz_sweep_path(w->scene, node->value, branches_aim(w, t), w->branches->maps);
  kz_sweep_follow(&path, w->scene->sweep->max_period, &node->entry.point, node->step, record);
  return KZ_OK;
}

/* The node of a value that is this very cycle; -1 where there is none. */
static int64_t find_node(const walking *w, int64_t value, const kz_attractor *point) {
  kz_pendulum pendulum;
  if (!kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, value), &pendulum)) return -1;
  for (int64_t i = 0; i < w->branches->n_nodes; i++) {
    const kz_sweep_node *node = w->branches->nodes + i;
    if (node->value == value && !node->between && node->entry.point.period > 0 &&
        kz_branch_same(w->branches->maps, &pendulum, &node->entry.point, point))
      return i;
  }
  return -1;
}

static void set_end(kz_sweep_node *node, bool forward, double last, int32_t kind) {
  *(forward ? &node->last : &node->first) = last;
  *(forward ? &node->last_kind : &node->first_kind) = kind;
}

/* Whether the way on from a node is known: to its neighbour, or its end. */
static bool is_known(const kz_sweep_node *node, bool forward) {
  return (forward ? node->next : node->previous) >= 0 || !isnan(forward ? node->last : node->first);
}

/* Whether it is known otherwise than by a walk that was lost. */
static bool is_certain(const kz_sweep_node *node, bool forward) {
  return is_known(node, forward) && ((forward ? node->next : node->previous) >= 0 ||
                                     (forward ? node->last_kind : node->first_kind) != KZ_END_NOT_LOCATED);
}

/* Whether an asymmetric piece arrives at its own mirror image: a step over a symmetry breaking went astray. */
static bool is_astray(const walking *w, int64_t value, const kz_attractor *point) {
  kz_pendulum pendulum;
  if (point->symmetric || !kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, value), &pendulum) ||
      !kz_pairing_symmetry(&pendulum))
    return false;
  const kz_attractor image = kz_branch_point_image(&pendulum, *point);
  return kz_branch_same(w->branches->maps, &pendulum, point, &image);
}

/* The node where a piece arrives; -1 = nowhere, or there are too many. */
static int64_t branches_arrival(const walking *w, const task *t, const kz_sweep_piece *piece,
                                const kz_attractor *point) {
  kz_sweep_branches *b = w->branches;
  if (piece->reached < 0) return -1;
  const int64_t value = piece->reached ? branches_aim(w, t) : b->nodes[t->node].value;
  const int64_t known = find_node(w, value, point);
  if (known < 0 && is_astray(w, value, point)) return -1;
  int64_t here = 0;
  for (int64_t i = 0; i < b->n_nodes && known < 0; i++) here += b->nodes[i].value == value;
  if (known >= 0 || here >= 2 * KZ_SWEEP_MOST) return known;
  return add_node(b, &(kz_sweep_entry){.point = *point, .number = {NAN, NAN, NAN}}, value, piece->attracts);
}

/* A piece that reaches neither value: one for a motion and its image. */
static void add_between(kz_sweep_branches *b, int64_t value, const kz_sweep_piece *piece) {
  const double low = fmin(piece->begin, piece->end), high = fmax(piece->begin, piece->end),
               near = 1e-9 * fmax(fabs(low), fabs(high));
  const bool turned = piece->begin > piece->end;
  for (int64_t i = 0; i < b->n_nodes; i++) {
    const kz_sweep_node *node = b->nodes + i;
    if (node->between && node->attracts == piece->attracts && node->entry.point.period == piece->point.period &&
        node->entry.point.symmetric == piece->point.symmetric &&
        abs(node->entry.point.winding) == abs(piece->point.winding) && fabs(node->first - low) <= near &&
        fabs(node->last - high) <= near)
      return;
  }
  const int64_t number =
      add_node(b, &(kz_sweep_entry){.point = piece->point, .number = {NAN, NAN, NAN}}, value, piece->attracts);
  kz_sweep_node *node = b->nodes + number;
  node->between = 1;
  set_end(node, false, low, turned ? piece->end_kind : piece->begin_kind);
  set_end(node, true, high, turned ? piece->begin_kind : piece->end_kind);
}

/* Joins both ends of a piece: `point` is its end, or that of its image. */
static void branches_join(const walking *w, const task *t, const kz_sweep_piece *piece, const kz_attractor *point) {
  kz_sweep_branches *b = w->branches;
  const int64_t from = piece->from_start ? t->node : -1, there = branches_arrival(w, t, piece, point);
  if (there >= 0 && b->nodes[there].step == 0) b->nodes[there].step = piece->step;
  const bool side = piece->reached == 1 ? !t->forward : t->forward; /* on which the piece arrives */
  if (from >= 0 && there >= 0 && piece->reached == 1) {
    kz_sweep_node *a = b->nodes + from, *c = b->nodes + there;
    if (is_certain(a, t->forward) || a->attracts != c->attracts) return;
    if (is_certain(c, side)) return; /* another cycle has arrived there before */
    *(t->forward ? &a->next : &a->previous) = there;
    *(side ? &c->next : &c->previous) = from;
    return;
  }
  if (from >= 0 && !is_known(b->nodes + from, t->forward)) {
    const bool lost = piece->reached >= 0;
    set_end(b->nodes + from, t->forward, lost ? kz_sweep_value(w->scene->sweep, b->nodes[from].value) : piece->end,
            lost ? KZ_END_NOT_LOCATED : piece->end_kind);
  }
  if (from < 0 && there >= 0 && !is_known(b->nodes + there, side))
    set_end(b->nodes + there, side, piece->begin, piece->begin_kind);
  const int64_t value = b->nodes[t->node].value - (t->forward ? 0 : 1);
  if (from < 0 && piece->reached < 0 && piece->end_kind != KZ_END_NOT_LOCATED) add_between(b, value, piece);
}

/* Node with the image of a task's cycle, if the pendulum is symmetric to the task's end; -1 = none. */
static int64_t image_node(const walking *w, const task *t) {
  const kz_sweep_node *node = w->branches->nodes + t->node;
  kz_pendulum pendulum, last;
  if (node->entry.point.symmetric ||
      !kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, node->value), &pendulum) ||
      !kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, branches_aim(w, t)), &last) ||
      !kz_pairing_symmetry(&pendulum) || kz_pairing_symmetry(&pendulum) != kz_pairing_symmetry(&last))
    return -1;
  const kz_attractor image = kz_branch_point_image(&pendulum, node->entry.point);
  const int64_t found = find_node(w, node->value, &image);
  return found == t->node ? -1 : found;
}

/* Joins a piece by the image of where it ends. */
static void join_image(const walking *w, const task *t, const kz_sweep_piece *piece) {
  const int64_t value = piece->reached == 1 ? branches_aim(w, t) : w->branches->nodes[t->node].value;
  kz_pendulum pendulum;
  if (piece->reached < 0 || !kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, value), &pendulum)) return;
  const kz_attractor image = kz_branch_point_image(&pendulum, piece->point);
  branches_join(w, t, piece, &image);
}

static void join_walk(const walking *w, const task *t, const kz_sweep_walk *walk) {
  for (int64_t i = 0; i < walk->count; i++) {
    branches_join(w, t, walk->piece + i, &walk->piece[i].point);
    if (walk->piece[i].twice) join_image(w, t, walk->piece + i);
  }
}

/* The image of a cycle, if its own walk was lost, goes where the image of the cycle's way leads: a step over a symmetry
 * breaking may arrive at the wrong cycle. */
static void join_lost_image(const walking *w, const task *t, const kz_sweep_walk *walk) {
  const task image = {image_node(w, t), t->forward};
  if (image.node < 0 || is_certain(w->branches->nodes + image.node, t->forward)) return;
  for (int64_t i = 0; i < walk->count; i++) {
    if (!walk->piece[i].from_start) continue;
    if (walk->piece[i].reached < 0)
      branches_join(w, &image, walk->piece + i, &walk->piece[i].point);
    else
      join_image(w, &image, walk->piece + i);
  }
}

/* The cycles whose way on is not known, the ends of the range left out. */
static int64_t list_tasks(const walking *w, bool forward, task *tasks) {
  const int64_t edge = forward ? w->scene->sweep->values.count - 1 : 0;
  int64_t n = 0;
  for (int64_t i = 0; i < w->branches->n_nodes; i++) {
    const kz_sweep_node *node = w->branches->nodes + i;
    if (node->entry.point.period == 0 || node->between || node->value == edge || is_known(node, forward)) continue;
    tasks[n++] = (task){i, forward};
  }
  return n;
}

/* One round of walks from all cycles whose way on is not known; *n = how many there were. */
static kz_status walk_round(walking *w, const kz_run *run, bool forward, int64_t *n) {
  KZ_AUTOFREE task *tasks = kz_malloc((size_t)(w->branches->n_nodes + 1) * sizeof *tasks);
  *n = list_tasks(w, forward, tasks);
  if (*n == 0) return KZ_OK;
  KZ_AUTOFREE kz_sweep_walk *walks = kz_malloc((size_t)*n * sizeof *walks);
  const kz_stage stage = kz_stage_for_all("sweep branches", *n, sizeof *walks, walk_tile, w);
  w->tasks = tasks;
  KZ_TRY(kz_stage_run(run, &stage, walks));
  for (int64_t i = 0; i < *n; i++) {
    join_walk(w, tasks + i, walks + i);
    kz_sweep_node *node = w->branches->nodes + tasks[i].node;
    if (!is_known(node, forward)) /* reached by another cycle */
      set_end(node, forward, kz_sweep_value(w->scene->sweep, node->value), KZ_END_NOT_LOCATED);
  }
  for (int64_t i = 0; i < *n; i++) join_lost_image(w, tasks + i, walks + i);
  return KZ_OK;
}

static kz_status walk_all(walking *w, const kz_run *run) {
  int64_t n, walked = 1;
  while (walked > 0) {
    walked = 0;
    for (int forward = 1; forward >= 0; forward--) do {
        KZ_TRY(walk_round(w, run, forward, &n));
        walked += n;
      } while (n > 0);
  }
  return KZ_OK;
}

/* Joins motions that never close, which continuation cannot carry, to the nearest of their kind at the next value. */
static void join_open(kz_sweep_branches *b) {
  for (int64_t i = 0; i < b->n_nodes; i++) {
    int64_t best = -1;
    for (int64_t j = 0; b->nodes[i].entry.point.period == 0 && j < b->n_nodes; j++) {
      const kz_sweep_node *other = b->nodes + j;
      const kz_attractor *own = &b->nodes[i].entry.point;
      if (!kz_branch_alike(own, &other->entry.point) || other->value != b->nodes[i].value + 1 || other->previous >= 0)
        continue;
      if (best < 0 ||
          kz_branch_points_apart(own, &other->entry.point) < kz_branch_points_apart(own, &b->nodes[best].entry.point))
        best = j;
    }
    if (best < 0) continue;
    b->nodes[i].next = best;
    b->nodes[best].previous = i;
  }
}

/* Order of branches: attracting first; by points; by the first value, then first strobe velocity and angle. */
static bool branches_before(const kz_sweep_node *a, const kz_sweep_node *b) {
  const kz_attractor *p = &a->entry.point, *q = &b->entry.point;
  const double keys[][2] = {{!a->attracts, !b->attracts},      {a->between, b->between},
                            {kz_branch_points_order(p, q), 0}, {(double)a->value, (double)b->value},
                            {p->velocity, q->velocity},        {p->theta, q->theta}};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (keys[i][0] != keys[i][1]) return keys[i][0] < keys[i][1];
  return false;
}

static void list_branches(kz_sweep_branches *b) {
  b->first_node = kz_malloc((size_t)(b->n_nodes + 1) * sizeof *b->first_node);
  for (int64_t i = 0; i < b->n_nodes; i++) {
    if (b->nodes[i].previous >= 0) continue;
    int64_t j = b->n_branches++;
    for (; j > 0 && branches_before(b->nodes + i, b->nodes + b->first_node[j - 1]); j--)
      b->first_node[j] = b->first_node[j - 1];
    b->first_node[j] = i;
  }
}

/* The births of running states, where nothing oscillates. */
static void locate_births(const kz_scene *scene, kz_sweep_branches *b) {
  for (int64_t i = 0; i < b->n_nodes; i++) {
    kz_sweep_node *node = b->nodes + i;
    for (int forward = 0; forward < 2; forward++) {
      const int64_t there = node->value + (forward ? 1 : -1);
      if (!kz_is_running(&node->entry.point) || is_known(node, forward) || there < 0 ||
          there >= scene->sweep->values.count)
        continue;
      const kz_path path = kz_sweep_path(scene, node->value, there, b->maps);
      const double birth = kz_running_birth(&path, node->entry.point.winding);
      if (!isnan(birth)) set_end(node, forward, birth, KZ_END_HOMOCLINIC);
    }
  }
}

/* Sets ends that no walk found: the first and last value of a branch; at the edges it leaves the range. */
static void set_known_ends(const kz_scene *scene, kz_sweep_branches *b) {
  for (int64_t i = 0; i < b->n_nodes; i++) {
    kz_sweep_node *node = b->nodes + i;
    const double value = kz_sweep_value(scene->sweep, node->value);
    if (node->between) continue;
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
  branches->maps = kz_fine_maps_create(scene->sweep->values.count < MOST_MAPS ? scene->sweep->values.count : MOST_MAPS);
  for (int64_t i = 0; i < scene->sweep->values.count; i++)
    for (int64_t j = 0; j < catalogue[i].count; j++) add_node(branches, catalogue[i].entries + j, i, true);
  KZ_TRY(walk_all(&w, run));
  join_open(branches);
  locate_births(scene, branches);
  set_known_ends(scene, branches);
  list_branches(branches);
  return KZ_OK;
}
