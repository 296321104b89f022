/* The search for the least path between two cycles, from many guesses. */
#include "guide.h"

/* Periods of a path: fewest and most; more when its ends are finished. */
enum { FEWEST = 24, MOST = 320 };
/* Factor of approach to cycles in the search; rad: distance where cycles are linear; distance at finished ends. */
static const double APPROACH = 300, LINEAR = 0.05, FINISHED = 1e-7;
/* Relative difference of actions of one family; those that are worth polishing, beside the least. */
static const double SAME = 1e-6, WORTH = 1.5;

/* Drive periods in which motions near the cycle, for a saddle in its stable plane, approach by a factor e. */
static double search_slowest(const kz_escape_cycle *cycle) {
  const kz_path_end *end = cycle->end;
  const double determinant = fabs(end->own[0][0] * end->own[1][1] - end->own[0][1] * end->own[1][0]),
               growth = fabs(end->growth);
  const double factor = growth < 1 ? growth : fmax(1 / growth, determinant / growth);
  return -(double)cycle->period / log(factor);
}

static int64_t search_clamped(double periods, int64_t low, int64_t high) {
  return periods<(double)low ? low : periods>(double) high ? high : (int64_t)periods;
}

static kz_guess guess_of(const kz_escape_cycle *from, const kz_escape_cycle *to, uint64_t seed, int64_t start) {
  static const double WIDTHS[] = {2, 4, 8, 16, 30};
  double u[4];
  for (int i = 0; i < 4; i++) u[i] = kz_path_random(seed, (uint64_t)(4 * start + i));
  const double leaves = search_slowest(from) * log(APPROACH), approaches = search_slowest(to) * log(APPROACH);
  kz_guess guess = {.periods = search_clamped(leaves + fmin(approaches, 0.5 * MOST), FEWEST, MOST)};
  const double least = fmin(5, 0.2 * (double)guess.periods),
               most = fmin(fmax(45, approaches), 0.7 * (double)guess.periods);
  guess.phase = (int64_t)(u[0] * (double)from->period);
  guess.change = (double)guess.periods - (least + (most - least) * u[1]);
  guess.width = fmin(WIDTHS[(int)(5 * u[2])], 0.3 * (double)guess.periods);
  guess.turn = floor(3 * u[3]) - 1;
  return guess;
}

/* The family of an action; -1 where there is none yet. */
static int64_t family_of(const kz_escape_route *route, double action) {
  for (int64_t i = 0; i < route->count; i++)
    if (fabs(route->action[i] - action) < SAME * fabs(action)) return i;
  return -1;
}

/* A family joins the list in the order of actions; the last one goes where the list is full. */
static void add_family(kz_escape_route *route, double action) {
  int64_t at = route->count < KZ_ESCAPE_FAMILIES ? route->count++ : KZ_ESCAPE_FAMILIES;
  for (; at > 0 && route->action[at - 1] > action; at--) {
    if (at == KZ_ESCAPE_FAMILIES) continue;
    route->action[at] = route->action[at - 1];
    route->hits[at] = route->hits[at - 1];
  }
  if (at == KZ_ESCAPE_FAMILIES) return;
  route->action[at] = action;
  route->hits[at] = 0;
}

/* Keeps a path where it is the least so far. */
static void keep_least(const kz_path *path, int64_t phase, kz_escape_route *route) {
  if (!(path->action < route->least.action)) return;
  route->least = *path;
  route->phase = phase;
  route->least.node = NULL;
  memcpy(route->node, path->node, (size_t)(4 * (path->n + 1)) * sizeof *path->node);
}

/* Polishes a path; then again with more periods near its cycles, where it ends farther than `distance` from one. */
static bool polish_to(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to, int64_t phase,
                      double distance, kz_path *path) {
  const kz_escape_cycle *cycle[2] = {from, to};
  int64_t more[2];
  if (!kz_path_polish(flow->flow, from->end + phase, to->end, path)) return false;
  for (int side = 0; side < 2; side++) {
    const double periods = search_slowest(cycle[side]) * log(fmax(1, path->beyond[side] / distance));
    more[side] = periods > 0 ? search_clamped(periods, 0, (KZ_ESCAPE_NODES - 1 - path->n) / 2 - cycle[side]->period) /
                                       cycle[side]->period +
                                   1
                             : 0;
  }
  if (more[0] + more[1] == 0) return true;
  kz_path_lengthen(flow->flow, from->end + phase, to->end, more, path);
  return kz_path_polish(flow->flow, from->end + phase, to->end, path);
}

void kz_escape_search(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      int64_t starts, uint64_t seed, kz_escape_route *route) {
  KZ_AUTOFREE double *theta = kz_malloc(((size_t)MOST * (size_t)flow->samples + 1) * sizeof *theta);
  route->count = route->starts = 0;
  route->least = (kz_path){.action = INFINITY};
  for (int64_t i = 0; i < starts; i++) {
    const kz_guess guess = guess_of(from, to, seed, i);
    kz_path path = {.n = guess.periods, .node = kz_malloc((size_t)(4 * (guess.periods + 1)) * sizeof(double))};
    kz_escape_guess(flow, from, to, &guess, theta, path.turns);
    const double relaxed = kz_path_relax(flow->pendulum, path.n, flow->samples, route->least.action, theta, path.node);
    route->starts += isfinite(relaxed);
    int64_t family = family_of(route, relaxed);
    if (family < 0 && relaxed < WORTH * route->least.action && polish_to(flow, from, to, guess.phase, LINEAR, &path) &&
        path.action > 0 && path.beyond[1] < 2 * LINEAR) {
      if (family_of(route, path.action) < 0) add_family(route, path.action);
      family = family_of(route, path.action);
      keep_least(&path, guess.phase, route);
    }
    if (family >= 0) route->hits[family]++;
    free(path.node);
  }
}

static double largest_torque(const kz_escape_flow *flow, const kz_path *path) {
  KZ_AUTOFREE double (*sample)[4] = kz_malloc((size_t)flow->samples * sizeof *sample);
  double largest = 0;
  for (int64_t t = 0; t < path->n; t++) {
    kz_hamilton_sample(flow->flow, flow->samples, path->node + 4 * t, sample[0]);
    for (int32_t i = 0; i < flow->samples; i++) largest = fmax(largest, 2 * flow->pendulum->beta * fabs(sample[i][3]));
  }
  return largest;
}

bool kz_escape_finish(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      kz_escape_route *route) {
  kz_path path = route->least;
  const size_t bytes = (size_t)(4 * (path.n + 1)) * sizeof *path.node;
  path.node = kz_malloc(bytes);
  memcpy(path.node, route->node, bytes);
  const bool good = polish_to(flow, from, to, route->phase, FINISHED, &path);
  if (good) {
    route->least.action = INFINITY;
    keep_least(&path, route->phase, route);
    route->largest_torque = largest_torque(flow, &path);
  }
  free(path.node);
  return good;
}
