/* Study `edge`: the saddle on the edge between the basins of two starts. The search for attractors is shared by all ranks, the edge is
 * followed as one tile. */
#include "edge.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "labelling/labeller.h"
#include "labelling/listed.h"
#include "cells/scene_search.h"
#include "kapitza/dynamics_cycles.h"

/* ---- J. D. Skufca, J. A. Yorke, B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101: edge tracking ---- */

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

/* Bisects between the plan's two starts and follows the edge of the first one's basin; it bisects again whenever the sides have separated.
 * orbit [plan->periods + 1][2] = states on the edge, rad and rad per drive radian. KZ_REFUSED if both starts end on the same attractor. */
static kz_status track(const kz_scene *scene, kz_dynamics *dynamics, int64_t max_periods, kz_edge *edge, double *orbit) {
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

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  int64_t max_periods;
} edge_job;

kz_cost kz_edge_cost(const kz_scene *scene) {
  const double bytes = 64 * ((double)scene->edge->periods + 1) + 40 * (double)kz_search_of(scene).starts;
  return (kz_cost){.disk_bytes = bytes, .memory_bytes = bytes};
}

/* Record: the edge, then its orbit [periods + 1][2]. */
static kz_status edge_tile(void *context, int64_t tile, void *record) {
  const edge_job *e = context;
  (void)tile;
  return track(e->scene, e->dynamics, e->max_periods, record, (double *)((kz_edge *)record + 1));
}

static void name_of(const edge_job *e, int32_t number, char name[KZ_NAME_LENGTH]) {
  kz_attractor row;
  snprintf(name, KZ_NAME_LENGTH, "not settled");
  if (number > 0) {
    kz_dynamics_attractor(e->dynamics, number, &row);
    kz_orbit_name(row.period, row.winding, row.centre, name);
  }
}

/* The id in the group saddles, -1 = not there. */
static int64_t saddle_of(const kz_edge *edge, const kz_listed *saddles) {
  int64_t saddle = -1;
  for (int64_t i = 0; i < saddles->count * saddles->phases; i++)
    if (hypot(remainder(saddles->theta[i] - edge->theta[0], 2 * M_PI), saddles->velocity[i] - edge->velocity[0]) < 1e-8)
      saddle = i / saddles->phases;
  return saddle;
}

static kz_status write_group(const kz_edge *edge, const double *orbit, kz_store *store) {
  const int64_t n = edge->n_periods + 1;
  KZ_TRY(kz_store_dimension(store, "edge", "strobe", n, NULL));
  KZ_TRY(kz_store_dimension(store, "edge", "phase", edge->cycle.period, NULL));
  KZ_COLUMN(store, "edge", "theta", n, double, orbit[2 * i]);
  KZ_COLUMN(store, "edge", "velocity", n, double, orbit[2 * i + 1]);
  KZ_TRY(kz_store_variable(store, "edge", "strobe_theta", edge->theta));
  KZ_TRY(kz_store_variable(store, "edge", "strobe_velocity", edge->velocity));
  KZ_TRY(kz_store_integer(store, "edge", "period", edge->cycle.period));
  KZ_TRY(kz_store_integer(store, "edge", "winding", edge->cycle.winding));
  KZ_TRY(kz_store_real(store, "edge", "exponent", edge->exponent));
  for (int i = 0; edge->cycle.period > 0 && i < 2; i++) {
    char name[32];
    snprintf(name, sizeof name, "multiplier_%d_re", i + 1);
    KZ_TRY(kz_store_real(store, "edge", name, edge->cycle.multiplier_re[i]));
    snprintf(name, sizeof name, "multiplier_%d_im", i + 1);
    KZ_TRY(kz_store_real(store, "edge", name, edge->cycle.multiplier_im[i]));
  }
  return KZ_OK;
}

/* Writes the group edge, and prints the edge state and the attractors on its two sides. */
static kz_status publish(const edge_job *e, const kz_edge *edge, const double *orbit, const kz_listed *saddles, kz_store *store,
                         FILE *summary) {
  char first[KZ_NAME_LENGTH], second[KZ_NAME_LENGTH], name[KZ_NAME_LENGTH] = "no cycle", full[KZ_NAME_LENGTH + 10] = "";
  name_of(e, edge->first_end, first);
  name_of(e, edge->second_end, second);
  if (edge->cycle.period > 0) kz_orbit_name(edge->cycle.period, edge->cycle.winding, edge->cycle.centre, name);
  snprintf(full, sizeof full, "%s%s", edge->cycle.period > 0 ? "unstable " : "", name);
  KZ_TRY(write_group(edge, orbit, store));
  KZ_TRY(kz_store_text(store, "edge", "name", full));
  KZ_TRY(kz_store_text(store, "edge", "first_end", first));
  KZ_TRY(kz_store_text(store, "edge", "second_end", second));
  KZ_TRY(kz_store_integer(store, "edge", "saddle", saddle_of(edge, saddles)));
  fprintf(summary, "Edge between %s and %s: ", first, second);
  if (edge->cycle.period > 0)
    fprintf(summary,
            "%s of period %d at theta = %.10g, velocity = %.10g, with multipliers %.10g and %.3g, found after %" PRId64
            " periods.\n",
            full, edge->cycle.period, edge->theta[0], edge->velocity[0], edge->cycle.multiplier_re[0],
            edge->cycle.multiplier_re[1], edge->n_periods);
  else
    fprintf(summary,
            "no cycle of at most %" PRId64 " periods was found in %" PRId64
            " periods; the distance of the two sides grows by exp(%.4g) per period: %s.\n",
            e->scene->edge->max_period, edge->n_periods, edge->exponent,
            edge->exponent > 0 ? "a chaotic saddle, or a long cycle" : "not settled");
  return KZ_OK;
}

kz_status kz_edge_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const size_t bytes = sizeof(kz_edge) + 2 * ((size_t)scene->edge->periods + 1) * sizeof(double);
  const kz_search search = kz_search_of(scene);
  KZ_FREED_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_search_dynamics(scene);
  edge_job e = {scene, dynamics, search.max_periods};
  const kz_stage stage = kz_stage_for_rank0("edge", 1, bytes, edge_tile, &e);
  KZ_FREED kz_edge *record = kz_malloc(bytes);
  KZ_TRY(kz_search_window(run, dynamics, &search, NULL));
  KZ_TRY(kz_stage_run(run, &stage, record));
  KZ_FREED_BY(kz_listed_free) kz_listed saddles;
  KZ_TRY(kz_listed_read(run, store, "saddles", "saddle", &saddles));
  return store ? publish(&e, record, (const double *)(record + 1), &saddles, store, summary) : KZ_OK;
}
