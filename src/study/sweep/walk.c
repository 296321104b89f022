/* One cycle carried along a parameter, with its events. */
#include "numerics/parent.h"
#include "sweep.h"

enum { MOST_ROWS = 400, MOST_EVENTS = 64, DEEPEST = 8 };
/* Steps of a branch, in distances of the two values: longest, beyond the second value; first where none is known. */
static const double LONGEST = 1.2, FIRST = 0.125;
/* An event that is not a merger lies so near to where the walk has found it. */
static const double NEAR = 0.3;
/* A cycle is followed so near to the value where damping ends. */
static const double STUCK = 1e-6;

/* A walk: its path, on which a place is 0 at the first value and 1 at the second, its longest period, and its findings.
 */
typedef struct {
  const kz_path *path;
  kz_plane plane, rough; /* rough: with half of the steps, for the way; what is kept is solved on the other one */
  int64_t max_period;
  kz_sweep_walk *found;
} walking;

static double value_at(const kz_path *path, double place) {
  return place == 1 ? path->to : path->from + place * (path->to - path->from);
}

static bool pendulum_at(const void *context, const double place[2], kz_pendulum *pendulum) {
  const kz_path *path = context;
  return path->pendulum(path->context, value_at(path, place[0]), pendulum);
}

/* The plane of a path; false where its first value has no pendulum. */
static bool plane_of(const kz_path *path, kz_plane *plane) {
  kz_pendulum pendulum, last;
  kz_numerics fine;
  if (!pendulum_at(path, (double[]){0, 0}, &pendulum)) return false;
  int32_t symmetry = kz_pairing_symmetry(&pendulum);
  if (pendulum_at(path, (double[]){1, 0}, &last) && kz_pairing_symmetry(&last) != symmetry) symmetry = 0;
  kz_numerics_fine(&pendulum, &fine);
  *plane = (kz_plane){.pendulum = pendulum_at,
                      .context = path,
                      .low = {0, -1},
                      .high = {1, 1},
                      .steps = 2 * fine.steps_per_period, /* Newton's method takes half of them */
                      .mirrored = symmetry == KZ_SYMMETRY_MIRROR,
                      .half_period = symmetry == KZ_SYMMETRY_HALF_PERIOD};
  return true;
}

static bool is_symmetric(const kz_cycle *c) {
  return c->kind.side < 0 || c->kind.rest;
}

/* The cycle through a strobe point at a place. Long ones have points several periods apart: so few that a pair of them
 * lies half a cycle apart. */
static bool cycle_of(const kz_plane *plane, const kz_attractor *point, double place, kz_cycle *c) {
  const bool half = point->symmetric && plane->half_period, mirrored = point->symmetric && plane->mirrored;
  const bool halved = half || (mirrored && point->period > 1);
  const int n = halved ? (point->period + half) / 2 : point->period;
  int stride = 1;
  while (n % stride != 0 || n / stride > KZ_CURVE_POINTS || (n % 2 == 0 && n / stride % 2 != 0)) stride++;
  KZ_AUTOFREE double *state = kz_malloc(2 * ((size_t)n + 1) * sizeof *state);
  *c = (kz_cycle){.kind = {.side = halved ? -1 : 1,
                           .points = n / stride,
                           .stride = stride > 1 ? stride : 0,
                           .half = half,
                           .rest = mirrored && !halved ? 1 + (cos(point->theta) < 0) : 0},
                  .place = {place, 0}};
  state[0] = point->theta, state[1] = point->velocity;
  if (!kz_curve_orbit(plane, c->place, 2, n - half, state)) return false;
  if (half && !kz_curve_orbit(plane, c->place, 1, 1, state + 2 * (n - 1))) return false;
  for (int i = 0; i < n / stride; i++) memcpy(c->point[i], state + 2 * i * stride, sizeof c->point[i]);
  c->kind.turns = (int32_t)rint((state[2 * n] - c->kind.side * state[0]) / (2 * M_PI));
  return true;
}

/* The point of a branch that a cycle is. */
static bool walk_describe(const walking *w, const kz_cycle *c, kz_attractor *point) {
  kz_pendulum pendulum;
  const double *place = c->place;
  const bool at_end = *place == 0 || *place == 1;
  if (!pendulum_at(w->path, place, &pendulum)) return false;
  const bool halved = c->kind.side < 0 && !c->kind.rest;
  const int points = c->kind.points;
  int n = halved && !c->kind.half ? 2 * points : points;
  double state[2 * KZ_CURVE_POINTS + 1][2];
  memcpy(state, c->point, (size_t)points * sizeof *state);
  for (int i = points; i < n; i++) /* a symmetric cycle goes on with its image */
    state[i][0] = -c->point[i - points][0], state[i][1] = -c->point[i - points][1];
  if (c->kind.half && c->kind.stride > 1) n = 1; /* its points are not equally far apart */
  for (; c->kind.half && n > 1 && n < 2 * points - 1; n++) {
    double half[4] = {c->point[n - points][0], c->point[n - points][1]};
    if (!kz_curve_orbit(&w->plane, place, 1, 1, half)) return false;
    state[n][0] = -half[2], state[n][1] = -half[3];
  }
  *point = (kz_attractor){.period = kz_kind_period(&c->kind), .symmetric = is_symmetric(c)};
  kz_branch_describe(at_end ? w->path->maps : NULL, &pendulum, n, state[0], point);
  if (!w->plane.mirrored && !w->plane.half_period && kz_pairing_symmetry(&pendulum)) { /* at this value alone */
    const kz_attractor image = kz_branch_point_image(&pendulum, *point);
    point->symmetric = kz_branch_same(w->path->maps, &pendulum, point, &image);
  }
  return true;
}

/* Without damping areas stay, and nothing attracts. */
static bool is_damped(const walking *w, double place) {
  kz_pendulum pendulum;
  return pendulum_at(w->path, (double[]){place, 0}, &pendulum) && pendulum.beta > 0;
}

/* The cycle at place 0 or 1, between two rows of a branch. */
static bool solve_at(const walking *w, const kz_cycle *before, const kz_cycle *after, double place, kz_cycle *there) {
  const int n = before->kind.points;
  const double share = (place - before->place[0]) / (after->place[0] - before->place[0]);
  double farthest = 1e-6;
  *there = *before;
  for (int i = 0; i < n; i++)
    for (int c = 0; c < 2; c++) {
      there->point[i][c] = before->point[i][c] + share * (after->point[i][c] - before->point[i][c]);
      farthest = fmax(farthest, fabs(after->point[i][c] - before->point[i][c]));
    }
  const kz_cycle guess = *there;
  there->place[0] = place, there->place[1] = 0;
  if (!kz_cycle_solve(&w->plane, there)) return false;
  for (int i = 0; i < n; i++)
    for (int c = 0; c < 2; c++)
      if (!(fabs(there->point[i][c] - guess.point[i][c]) <= farthest)) return false;
  return true;
}

/* Kind of an event of a branch, and the refined cycle with that multiplier: 1, or -1 of its own map. */
static int kind_of_event(const walking *w, const kz_cycle *event, kz_cycle *at) {
  const bool merges = event->event > KZ_EVENT_FLIP;
  int kind = KZ_END_FOLD;
  *at = *event;
  if (merges) {
    if (!kz_cycle_parent(&w->plane, event, at)) return KZ_END_NOT_LOCATED;
    kind = event->event == KZ_EVENT_MIRROR ? KZ_END_SYMMETRY_BREAKING : KZ_END_PERIOD_DOUBLING;
  } else if (event->event == KZ_EVENT_FLIP) {
    at->kind.multiplier = -1;
    kind = event->kind.side < 0 ? KZ_END_SYMMETRY_BREAKING : KZ_END_PERIOD_DOUBLING;
  } else if (event->kind.rest) { /* on the half map this is a multiplier -1 */
    at->kind =
        (kz_cycle_kind){.side = -1, .points = 1, .multiplier = -1, .turns = at->kind.rest - 1, .rest = at->kind.rest};
    at->point[0][0] = kz_kind_rest(&at->kind), at->point[0][1] = 0; /* not -pi */
    kind = KZ_END_SYMMETRY_BREAKING;
  } else {
    at->kind.multiplier = 1;
  }
  kz_cycle refined = *at;
  if (!kz_cycle_locate(&w->plane, &refined, (double[]){1, 0})) return merges ? KZ_END_NOT_LOCATED : kind;
  if (merges || fabs(refined.place[0] - at->place[0]) < NEAR) *at = refined;
  return kind;
}

static void walk_follow(const walking *w, const kz_cycle *c, const double along[2], kz_sweep_piece piece, int depth);

/* Follows the daughter of an event, within the segment. */
static void follow_child(const walking *w, const kz_cycle *flip, int kind, int depth) {
  kz_cycle child;
  double along[2];
  if (depth == DEEPEST || !kz_cycle_child(&w->plane, flip, 0, &child, along) ||
      kz_kind_period(&child.kind) > w->max_period)
    return;
  const kz_sweep_piece piece = {.begin = value_at(w->path, flip->place[0]),
                                .begin_kind = kind,
                                .reached = -1,
                                .step = FIRST,
                                .twice = is_symmetric(flip) && child.kind.side > 0};
  walk_follow(w, &child, along, piece, depth + 1);
}

/* A branch that is cut into pieces where something happens. */
typedef struct {
  const walking *w;
  const kz_cycle *c;    /* near its begin */
  kz_sweep_piece piece; /* piece that has begun */
  bool sign[2];         /* whether 1 - trace + determinant and 1 + trace + determinant are positive */
  bool passes;          /* whether it ends beyond the second value, but reaches it */
  kz_cycle beyond;      /* cycle beyond the second value */
} branching;

static void add_piece(const branching *b) {
  kz_sweep_walk *found = b->w->found;
  if (found->count < KZ_SWEEP_PIECES) found->piece[found->count++] = b->piece;
}

/* Ends a piece at an event and begins the next one; false where the branch ends there. */
static bool walk_pass(branching *b, const kz_cycle *event, int depth) {
  const bool merges = event->event > KZ_EVENT_FLIP;
  kz_cycle at;
  if (!merges && !(event->place[0] >= 0 && event->place[0] <= 1)) return true;
  const int kind = kind_of_event(b->w, event, &at);
  if (merges && !(at.place[0] >= 0 && at.place[0] <= 1)) {
    b->passes = true;
    b->beyond = *event;
    b->beyond.place[0] = at.place[0];
    return true;
  }
  b->piece.end = value_at(b->w->path, at.place[0]), b->piece.end_kind = kind,
  b->piece.attracts = b->sign[0] && b->sign[1];
  if (!walk_describe(b->w, event, &b->piece.point)) b->piece.point.period = kz_kind_period(&b->c->kind);
  add_piece(b);
  if (merges) return false;
  b->sign[event->event == KZ_EVENT_FOLD ? 0 : 1] ^= true;
  b->piece = (kz_sweep_piece){.begin = b->piece.end, .begin_kind = kind, .reached = -1, .step = b->piece.step};
  if (at.kind.multiplier < 0 && b->w->max_period > 0) follow_child(b->w, &at, kind, depth);
  return true;
}

/* Ends the last piece, between the last two rows: at a value that the branch reaches, or where it is lost. */
static void walk_finish(branching *b, const kz_cycle *former, const kz_cycle *last, bool reaches) {
  const double at = last->place[0], place = at > 1 ? 1 : 0;
  kz_cycle there;
  b->piece.attracts = b->sign[0] && b->sign[1];
  if (reaches && solve_at(b->w, former, last, place, &there) && walk_describe(b->w, &there, &b->piece.point))
    b->piece.reached = place == 1;
  else if (b->piece.attracts && fabs(1 - at) < STUCK && !is_damped(b->w, 1)) /* complex multipliers at 1 */
    b->piece.end = b->w->path->to, b->piece.end_kind = KZ_END_NEIMARK_SACKER;
  else
    b->piece.end = value_at(b->w->path, fmin(fmax(at, 0), 1)), b->piece.end_kind = KZ_END_NOT_LOCATED;
  if (b->piece.reached >= 0 || walk_describe(b->w, b->c, &b->piece.point)) add_piece(b);
}

/* Follows a cycle along the way, with what branches off, until it leaves the way or ends. `piece`: how it begins. */
static void walk_follow(const walking *w, const kz_cycle *c, const double along[2], kz_sweep_piece piece, int depth) {
  KZ_AUTOFREE kz_cycle *row = kz_malloc(MOST_ROWS * sizeof *row), *event = kz_malloc(MOST_EVENTS * sizeof *event);
  const kz_branch_way to = {{along[0], along[1]}, LONGEST, piece.step, MOST_ROWS, MOST_EVENTS, 0};
  branching b = {.w = w, .c = c, .piece = piece};
  kz_branch_end end;
  kz_cycle_continue(&w->rough, c, &to, row, event, &end);
  b.piece.step = end.step;
  if (end.rows == 0) { /* nothing is known beyond its beginning */
    b.piece.end = value_at(w->path, c->place[0]), b.piece.end_kind = KZ_END_NOT_LOCATED;
    if (b.piece.from_start) add_piece(&b);
    return;
  }
  b.sign[0] = 1 + row->number[1] - row->number[0] > 0, b.sign[1] = 1 + row->number[1] + row->number[0] > 0;
  for (int64_t i = 0; i < end.events; i++)
    if (!walk_pass(&b, event + i, depth)) return;
  const kz_cycle *last = row + end.rows - 1, *former = end.rows > 1 ? last - 1 : last;
  if (b.passes)
    walk_finish(&b, last, &b.beyond, true);
  else
    walk_finish(&b, former, last, end.ending == KZ_TRACE_LEFT && end.rows > 1);
}

void kz_sweep_follow(const kz_path *path, int64_t max_period, const kz_attractor *point, double step,
                     kz_sweep_walk *found) {
  walking walk = {.path = path, .max_period = max_period, .found = found};
  kz_cycle c;
  found->count = 0;
  if (plane_of(path, &walk.plane) && cycle_of(&walk.plane, point, 0, &c)) {
    const kz_sweep_piece piece = {.from_start = 1, .reached = -1, .step = step > 0 ? step : FIRST};
    walk.rough = walk.plane;
    walk.rough.steps /= 2;
    walk_follow(&walk, &c, (double[]){1, 0}, piece, 0);
  }
  if (found->count == 0)
    found->piece[found->count++] = (kz_sweep_piece){
        .from_start = 1, .reached = -1, .end = path->from, .end_kind = KZ_END_NOT_LOCATED, .point = *point};
}

static bool same_pendulum(const void *context, double value, kz_pendulum *pendulum) {
  (void)value;
  *pendulum = *(const kz_pendulum *)context;
  return true;
}

kz_attractor kz_branch_point_image(const kz_pendulum *pendulum, kz_attractor point) {
  const kz_path here = {.pendulum = same_pendulum, .context = pendulum, .to = 1};
  double state[4] = {point.theta, point.velocity};
  kz_plane plane;
  point.winding = -point.winding;
  if (point.period > 0 && plane_of(&here, &plane) && plane.half_period &&
      kz_curve_orbit(&plane, (double[]){0, 0}, 1, 1, state))
    point.theta = state[2], point.velocity = state[3];
  point.theta = -point.theta;
  point.velocity = -point.velocity;
  return point;
}
