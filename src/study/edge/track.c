/* J. D. Skufca, J. A. Yorke, B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101: edge tracking. */
#include "edge.h"

#include <math.h>
#include <string.h>

#include "labelling/labeller.h"

enum { PIECES = 16, ROUNDS = 16 };
/* rad: sides are brought so near, and bisected again when they are so far apart. */
static const double NEAR = 1e-10, FAR = 1e-6;
/* rad: a cycle holds the edge where it comes back so near for HELD periods; the cycle lies so near. */
static const double BACK = 1e-5, BESIDE = 1e-3;
enum { HELD = 16 };

typedef struct {
  kz_dynamics *dynamics;
  kz_flow *map; /* of published values */
  int64_t max_periods;
  double side[2][2]; /* rad, rad per drive radian; the first one's end is `own` */
  int32_t own, other;
} pair;

static double wrapped(double angle) {
  return angle - 2 * M_PI * rint(angle / (2 * M_PI));
}

static double distance(const double *a, const double *b) {
  return hypot(wrapped(a[0] - b[0]), a[1] - b[1]);
}

/* Brings the sides together, about the first change of the end from the first side on. */
static kz_status bisect(pair *p) {
  double point[PIECES - 1][2];
  kz_label end[PIECES - 1];
  const kz_labeller labeller = kz_pair_labeller(point[0], p->max_periods, KZ_BY_LEVELS, p->dynamics);
  for (int round = 0; round < ROUNDS && distance(p->side[0], p->side[1]) > NEAR; round++) {
    const double step[2] = {wrapped(p->side[1][0] - p->side[0][0]) / PIECES, (p->side[1][1] - p->side[0][1]) / PIECES};
    for (int j = 1; j < PIECES; j++)
      for (int c = 0; c < 2; c++) point[j - 1][c] = p->side[0][c] + j * step[c];
    KZ_TRY(kz_label_items(&labeller, 1, PIECES - 1, NULL, end));
    int first = 0;
    while (first < PIECES - 1 && end[first].label == p->own) first++;
    if (first < PIECES - 1) {
      memcpy(p->side[1], point[first], sizeof p->side[1]);
      p->other = end[first].label;
    }
    if (first > 0) memcpy(p->side[0], point[first - 1], sizeof p->side[0]);
  }
  return KZ_OK;
}

/* Advances both sides by one period; returns ln of the growth of their distance. */
static double advance(pair *p) {
  const double before = distance(p->side[0], p->side[1]);
  double theta[2] = {p->side[0][0], p->side[1][0]}, velocity[2] = {p->side[0][1], p->side[1][1]};
  int64_t turns[2] = {0};
  kz_advance(p->map, 2, 1, theta, velocity, turns);
  for (int i = 0; i < 2; i++) {
    p->side[i][0] = theta[i];
    p->side[i][1] = velocity[i];
  }
  return log(distance(p->side[0], p->side[1]) / before);
}

static void middle(const pair *p, double *state) {
  state[0] = wrapped(p->side[0][0] + wrapped(p->side[1][0] - p->side[0][0]) / 2);
  state[1] = (p->side[0][1] + p->side[1][1]) / 2;
}

/* The fewest periods, at most `longest`, after which the orbit has come back for HELD periods; 0 = it has not. */
static int64_t held_period(const double *orbit, int64_t n, int64_t longest) {
  for (int64_t period = 1; period <= longest; period++) {
    int64_t back = 0;
    while (back < HELD && n - back - period >= 0 && distance(orbit + 2 * (n - back), orbit + 2 * (n - back - period)) < BACK)
      back++;
    if (back == HELD) return period;
  }
  return 0;
}

/* The saddle on the edge near `state`; false where there is none, or one with no unstable direction. */
static bool find_saddle(const kz_scene *scene, const double *state, int64_t n, kz_edge *edge) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  kz_numerics fine;
  kz_numerics_fine(pendulum, &fine);
  edge->theta[0] = state[0];
  edge->velocity[0] = state[1];
  kz_dynamics_close_cycle(pendulum, &fine, n, BESIDE, edge->theta, edge->velocity, &edge->cycle);
  if (!(hypot(edge->cycle.multiplier_re[0], edge->cycle.multiplier_im[0]) > 1)) edge->cycle.period = 0;
  for (int32_t i = 0; i < edge->cycle.period; i++)
    if (edge->theta[i] >= M_PI) edge->theta[i] = -M_PI;
  return edge->cycle.period > 0;
}

static kz_status follow_edge(const kz_scene *scene, pair *p, kz_edge *edge, double *orbit) {
  const kz_edge_plan *plan = scene->edge;
  double growth = 0;
  for (int64_t t = 0;; t++) {
    if (distance(p->side[0], p->side[1]) > FAR || t == 0) KZ_TRY(bisect(p));
    middle(p, orbit + 2 * t);
    edge->n_periods = t;
    edge->exponent = t > 0 ? growth / (double)t : NAN;
    const int64_t held = held_period(orbit, t, plan->max_period);
    if (held > 0 && find_saddle(scene, orbit + 2 * t, held, edge)) {
      edge->exponent = log(hypot(edge->cycle.multiplier_re[0], edge->cycle.multiplier_im[0])) / edge->cycle.period;
      return KZ_OK;
    }
    if (t == plan->periods) return KZ_OK;
    growth += advance(p);
  }
}

kz_status kz_edge_track(const kz_scene *scene, kz_dynamics *dynamics, int64_t max_periods, kz_edge *edge, double *orbit) {
  const kz_edge_plan *plan = scene->edge;
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  pair p = {.dynamics = dynamics,
            .max_periods = max_periods,
            .side = {{plan->first[0], plan->first[1]}, {plan->second[0], plan->second[1]}}};
  kz_label end[2];
  const kz_labeller labeller = kz_pair_labeller(p.side[0], max_periods, KZ_BY_LEVELS, dynamics);
  kz_numerics fine;
  kz_numerics_fine(pendulum, &fine);
  *edge = (kz_edge){.exponent = NAN};
  KZ_TRY(kz_label_items(&labeller, 1, 2, NULL, end));
  if (end[0].label == end[1].label)
    return kz_fail(KZ_REFUSED,
                   "edge.second|edge.first: ends on the same attractor as the other start; give starts of different basins");
  p.own = end[0].label;
  p.other = end[1].label;
  p.map = kz_flow_create(pendulum, &fine);
  const kz_status status = follow_edge(scene, &p, edge, orbit);
  edge->first_end = p.own;
  edge->second_end = p.other;
  kz_flow_free(p.map);
  return status;
}
