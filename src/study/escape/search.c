/* The search for the least path between two cycles, from many guesses. */
#include "guide.h"

/* Periods of a path: fewest and most; more when its ends are finished. */
enum { FEWEST = 24, MOST = 320, MAX_ROUNDS = 3 /* rounds of lengthening at most */ };
/* Factor by which a path comes near its cycles in the search; distance (rad) at which a cycle is linear. */
static const double APPROACH = 300, LINEAR = 0.05;
/* A path is refused that ends so many times farther from a cycle than it is asked to. */
static const double FAR = 10;
/* Relative difference of actions of one family; those that are worth polishing, beside the least. */
static const double SAME = 1e-6, WORTH = 1.5;

double kz_escape_slowest(const kz_path_end *end) {
  const double determinant = fabs(end->own[0][0] * end->own[1][1] - end->own[0][1] * end->own[1][0]),
               growth = fabs(end->growth);
  const double factor = growth < 1 ? growth : fmax(1 / growth, determinant / growth);
  return -(double)end->period / log(factor);
}

static int64_t search_clamped(double periods, int64_t low, int64_t high) {
  return periods<(double)low ? low : periods>(double) high ? high : (int64_t)periods;
}

/* The strobe of the attractor from which its motion stays nearest to that of the saddle, if both come to strobe 0 of
 * the saddle after n periods. */
static int64_t nearest_phase(int32_t samples, const kz_escape_cycle *from, const kz_escape_cycle *to, int64_t n) {
  int64_t best = 0;
  double least = INFINITY;
  for (int64_t phase = 0; phase < from->period; phase++) {
    double sum = 0;
    for (int64_t t = 0; t < from->period * to->period; t++)
      for (int32_t i = 0; i < samples; i++) {
        const int64_t strobe = ((t - n) % to->period + to->period) % to->period;
        const double apart = remainder(
            from->theta[(phase + t) % from->period * samples + i] - to->theta[strobe * samples + i], 2 * M_PI);
        sum += apart * apart;
      }
    if (sum < least) least = sum, best = phase;
  }
  return best;
}

/* One guess in three begins at the nearest phase, without more turns. */
static kz_guess guess_of(int32_t samples, const kz_escape_cycle *from, const kz_escape_cycle *to, uint64_t seed,
                         int64_t start) {
  static const double WIDTHS[] = {2, 4, 8, 16, 30};
  double u[4];
  for (int i = 0; i < 4; i++) u[i] = kz_path_random(seed, (uint64_t)(4 * start + i));
  const double leaves = kz_escape_slowest(from->end) * log(APPROACH),
               approaches = kz_escape_slowest(to->end) * log(APPROACH);
  kz_guess guess = {.periods = search_clamped(leaves + fmin(approaches, 0.5 * MOST), FEWEST, MOST)};
  const double least = fmin(5, 0.2 * (double)guess.periods),
               most = fmin(fmax(45, approaches), 0.7 * (double)guess.periods);
  guess.phase = (int64_t)(u[0] * (double)from->period);
  guess.change = (double)guess.periods - (least + (most - least) * u[1]);
  guess.width = fmin(WIDTHS[(int)(5 * u[2])], 0.3 * (double)guess.periods);
  guess.turn = floor(3 * u[3]) - 1;
  if (start % 3 != 0) return guess;
  guess.phase = nearest_phase(samples, from, to, guess.periods);
  guess.turn = 0;
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

bool kz_escape_polish(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, double distance,
                      kz_path *path) {
  const kz_path_end *end[2] = {from, to};
  for (int round = 0; round < MAX_ROUNDS; round++) {
    int64_t more[2];
    if (!kz_path_polish(flow, from, to, path)) return false;
    for (int side = 0; side < 2; side++) {
      const double periods = kz_escape_slowest(end[side]) * log(fmax(1, path->beyond[side] / distance));
      const int64_t room = (KZ_ESCAPE_NODES - 1 - path->n) / 2 - end[side]->period;
      more[side] = periods > 0 ? search_clamped(periods, 0, room) / end[side]->period + 1 : 0;
    }
    if (more[0] + more[1] == 0) return true;
    kz_path_lengthen(flow, from, to, more, path);
  }
  return kz_path_polish(flow, from, to, path) && fmax(path->beyond[0], path->beyond[1]) < FAR * distance;
}

void kz_escape_search(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      int64_t starts, uint64_t seed, kz_escape_route *route) {
  KZ_AUTOFREE double *theta = kz_malloc(((size_t)MOST * (size_t)flow->samples + 1) * sizeof *theta);
  route->count = route->starts = 0;
  route->least = (kz_path){.action = INFINITY};
  for (int64_t i = 0; i < starts; i++) {
    const kz_guess guess = guess_of(flow->samples, from, to, seed, i);
    kz_path path = {.n = guess.periods, .node = kz_malloc((size_t)(4 * (guess.periods + 1)) * sizeof(double))};
    kz_escape_guess(flow, from, to, &guess, theta, path.turns);
    const double relaxed =
        kz_path_relax(flow->pendulum, path.n, flow->samples, WORTH * route->least.action, theta, path.node);
    route->starts += isfinite(relaxed);
    int64_t family = family_of(route, relaxed);
    if (family < 0 && relaxed < WORTH * route->least.action &&
        kz_escape_polish(flow->coarse, from->end + guess.phase, to->end, LINEAR, &path) && path.action > 0 &&
        path.beyond[1] < 2 * LINEAR) {
      if (family_of(route, path.action) < 0) add_family(route, path.action);
      family = family_of(route, path.action);
      keep_least(&path, guess.phase, route);
    }
    if (family >= 0) route->hits[family]++;
    free(path.node);
  }
}

double kz_escape_torque(const kz_escape_flow *flow, const kz_path *path) {
  const int64_t n = path->n * flow->samples;
  KZ_AUTOFREE double (*sample)[4] = kz_malloc((size_t)n * sizeof *sample);
  double largest = 0;
  kz_hamilton_sample(flow->flow, flow->samples, path->n, path->node, sample[0]);
  for (int64_t i = 0; i < n; i++) largest = fmax(largest, 2 * flow->pendulum->beta * fabs(sample[i][3]));
  return largest;
}

bool kz_escape_finish(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      double distance, kz_escape_route *route) {
  kz_path path = route->least;
  const size_t bytes = (size_t)(4 * (path.n + 1)) * sizeof *path.node;
  path.node = kz_malloc(bytes);
  memcpy(path.node, route->node, bytes);
  const bool good = kz_escape_polish(flow->coarse, from->end + route->phase, to->end, distance, &path) &&
                    kz_path_polish(flow->flow, from->end + route->phase, to->end, &path);
  if (good) {
    route->least.action = INFINITY;
    keep_least(&path, route->phase, route);
    route->largest_torque = kz_escape_torque(flow, &path);
  }
  free(path.node);
  return good;
}
