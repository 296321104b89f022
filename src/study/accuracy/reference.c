#include "reference.h"

#include "numerics/cells.h"
#include "cells/cell_starts.h"
#include "cells/scene_search.h"
#include "numerics/share.h"
#include "numerics/steps.h"

enum {
  STEPS = 48,    /* Steps of split6 a period, for a gentle drive */
  DOUBLINGS = 6, /* Doublings of STEPS at most */
  MOST_STEPS = 20000,
  PROBES = 8192, /* cells that must settle on known attractors before any is followed in quad precision */
  ROUNDS = 3,    /* Rounds of search among probes that end nowhere known, at most */
  PROBE_TILE = 256,
  TILE = 32,                            /* cells */
  OTHER_STEPS = KZ_REFERENCE_STEPS + 6, /* the other number of steps of the series */
  ASKED = 8                             /* every so many cells the other number of steps is tried */
};

static const double FINE = 1e-8; /* rad: error of one period of the reference dynamics */

int64_t kz_reference_labels_cell(const kz_reference_labels *reference, int64_t i) {
  return kz_shuffled(i, reference->total, reference->plan->seed);
}

kz_status kz_reference_labels_numerics(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_numerics *numerics) {
  const double fastest = kz_axis_fastest(&plan->velocity);
  const double steps = kz_steps_by_stiffness(pendulum, STEPS), most = fmin(ldexp(steps, DOUBLINGS), MOST_STEPS);
  *numerics = (kz_numerics){.scheme = kz_scheme_find("split6"), .steps_per_period = (int32_t)fmin(steps, most)};
  if (steps <= most && kz_steps_enough(pendulum, fastest, FINE, (int32_t)most, numerics)) return KZ_OK;
  return kz_fail(KZ_REFUSED,
                 "basin.velocity: %d steps a period are too few for reference labels of starts with speed %.3g; choose "
                 "slower starts",
                 (int)numerics->steps_per_period, fastest);
}

/* From starts, then from probes that do not settle. */
static kz_status find_attractors(const kz_reference_labels *reference, const kz_run *run, kz_dynamics *dynamics) {
  const kz_basin_plan *plan = reference->plan;
  const int64_t probes = kz_smaller(reference->total, PROBES);
  const kz_search_on search_on = {ROUNDS, PROBES, NULL};
  kz_search search = kz_search_of_basin(plan);
  kz_labeller labeller = kz_cell_labeller(plan, dynamics);
  KZ_AUTOFREE int64_t *cell = kz_malloc((size_t)probes * sizeof *cell);
  KZ_AUTOFREE kz_label *label = kz_malloc((size_t)probes * sizeof *label);
  labeller.way = KZ_BY_STATES;
  labeller.run = run;
  labeller.stage = "probes";
  labeller.tile = PROBE_TILE;
  search.table_theta = 0;
  for (int64_t i = 0; i < probes; i++) cell[i] = kz_reference_labels_cell(reference, i);
  KZ_TRY(kz_search_window(run, dynamics, &search, NULL));
  return kz_label_and_search(&labeller, &search_on, probes, cell, label);
}

static kz_status reference_prepare(kz_reference_labels *reference, const kz_run *run, kz_dynamics *dynamics) {
  const kz_window window = kz_window_of(&reference->plan->theta, &reference->plan->velocity);
  KZ_TRY(kz_ranks_agree(run->ranks, find_attractors(reference, run, dynamics)));
  reference->max_velocity = kz_dynamics_max_velocity(dynamics, &window);
  reference->packed_size = kz_dynamics_pack(dynamics, 0, NULL);
  reference->packed = kz_malloc((size_t)reference->packed_size * sizeof(double));
  reference->labels = kz_calloc((size_t)reference->samples + 1, sizeof *reference->labels);
  kz_dynamics_pack(dynamics, reference->packed_size, reference->packed);
  return KZ_OK;
}

typedef struct {
  const kz_reference_labels *reference;
  kz_dynamics *dynamics;
  int64_t known; /* labels that were in the cache */
} reference_job;

/* The distance from each of n cells, along the axes, at which the label differs, in double precision. */
static kz_status find_distances(const reference_job *h, int64_t n, const int64_t *cell, kz_reference_label *labels) {
  const kz_basin_plan *plan = h->reference->plan;
  double start[8 * TILE];
  kz_label end[4 * TILE];
  const kz_labeller labeller = kz_pair_labeller(start, plan->max_periods, KZ_BY_STATES, h->dynamics);
  for (int64_t i = 0; i < n; i++) labels[i].distance = KZ_REFERENCE_FAR;
  for (int distance = KZ_REFERENCE_FAR / 2; distance > 0; distance /= 2) {
    const int64_t aside[4][2] = {{-distance, 0}, {distance, 0}, {0, -distance}, {0, distance}};
    for (int64_t i = 0; i < 4 * n; i++) {
      const int64_t *by = aside[i % 4], f = cell[i / 4];
      start[2 * i] = kz_axis_centre(&plan->theta, f % plan->theta.count + by[0]);
      start[2 * i + 1] = kz_axis_centre(&plan->velocity, f / plan->theta.count + by[1]);
    }
    KZ_TRY(kz_label_items(&labeller, 1, 4 * n, NULL, end));
    for (int64_t i = 0; i < 4 * n; i++)
      if (end[i].label != labels[i / 4].end.label) labels[i / 4].distance = (uint8_t)distance;
  }
  return KZ_OK;
}

static void reference_follow(const reference_job *h, int32_t steps, int64_t n, const kz_start *start,
                             kz_decision *end) {
  const kz_label_precision quads = {.level = KZ_LEVEL_QUAD, .series_steps = steps};
  kz_dynamics_label(h->dynamics, &quads, n, start, h->reference->plan->max_periods, end);
}

/* Whether every ASKED-th cell comes out the same with another number of steps. */
static void compare_steps(const reference_job *h, int64_t first, int64_t n, const kz_start *start,
                          kz_reference_label *labels) {
  kz_start asked[TILE] = {0};
  kz_decision end[TILE];
  int64_t place[TILE], n_asked = 0;
  for (int64_t i = 0; i < n; i++) {
    labels[i].agrees = 2;
    if ((first + i) % ASKED != 0) continue;
    asked[n_asked] = start[i];
    place[n_asked++] = i;
  }
  reference_follow(h, OTHER_STEPS, n_asked, asked, end);
  for (int64_t i = 0; i < n_asked; i++) labels[place[i]].agrees = end[i].end.label == labels[place[i]].end.label;
}

static kz_status label_samples(void *context, int64_t first, int64_t n, void *record) {
  const reference_job *h = context;
  kz_reference_label *labels = record;
  kz_start start[TILE] = {0};
  kz_decision end[TILE];
  int64_t cell[TILE];
  memcpy(labels, h->reference->labels + first, (size_t)n * sizeof *labels);
  if (first + n <= h->known) return KZ_OK;
  for (int64_t i = 0; i < n; i++) {
    double centre[2];
    cell[i] = kz_reference_labels_cell(h->reference, first + i);
    kz_cell_start(h->reference->plan, cell[i], centre);
    start[i] = kz_start_at(centre[0], centre[1]);
  }
  reference_follow(h, KZ_REFERENCE_STEPS, n, start, end);
  for (int64_t i = 0; i < n; i++) labels[i].end = end[i].end;
  compare_steps(h, first, n, start, labels);
  KZ_TRY(find_distances(h, n, cell, labels));
  for (int64_t i = 0; i < n; i++) {
    start[i].theta[0] = nextafter(start[i].theta[0], copysign(INFINITY, start[i].theta[0]));
    start[i].velocity[0] = nextafter(start[i].velocity[0], copysign(INFINITY, start[i].velocity[0]));
  }
  reference_follow(h, KZ_REFERENCE_STEPS, n, start, end);
  for (int64_t i = 0; i < n; i++) labels[i].flipped = end[i].end.label;
  return KZ_OK;
}

/* Labels that rank 0 has found in the cache are given to every rank. */
static kz_status follow_samples(kz_reference_labels *reference, const kz_run *run, const char *path,
                                kz_dynamics *dynamics) {
  reference_job h = {.reference = reference, .dynamics = dynamics};
  h.known = path ? kz_reference_labels_recall(path, reference) : 0;
  KZ_TRY(kz_ranks_broadcast(run->ranks, &h.known, sizeof h.known));
  KZ_TRY(kz_ranks_broadcast(run->ranks, reference->labels, (size_t)h.known * sizeof *reference->labels));
  const kz_stage stage = kz_stage_of_items("reference labels", reference->samples, TILE,
                                           TILE * sizeof(kz_reference_label), label_samples, &h);
  KZ_AUTOFREE kz_reference_label *records = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  KZ_TRY(kz_stage_run(run, &stage, records));
  memcpy(reference->labels, records, (size_t)reference->samples * sizeof *records);
  return KZ_OK;
}

kz_status kz_reference_labels_make(const kz_scene *scene, const kz_run *run, int64_t samples, const char *path,
                                   kz_reference_labels *reference) {
  const kz_basin_plan *plan = scene->basin;
  *reference = (kz_reference_labels){.plan = plan,
                                     .pendulum = scene->parameters.pendulum,
                                     .series = scene->series,
                                     .total = plan->theta.count * plan->velocity.count};
  reference->samples = kz_smaller(samples, reference->total);
  kz_numerics numerics;
  KZ_TRY(kz_ranks_agree(run->ranks, kz_reference_labels_numerics(plan, &reference->pendulum, &numerics)));
  KZ_AUTOFREE_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_dynamics_create(&reference->pendulum, &numerics, plan->max_period);
  KZ_TRY(reference_prepare(reference, run, dynamics));
  return follow_samples(reference, run, path, dynamics);
}

void kz_reference_labels_free(kz_reference_labels *reference) {
  free(reference->packed);
  free(reference->labels);
  *reference = (kz_reference_labels){0};
}

kz_reference_labels_summary kz_reference_labels_sum(const kz_reference_labels *reference) {
  kz_reference_labels_summary sum = {0};
  for (int64_t i = 0; i < reference->samples; i++) {
    const kz_reference_label *v = reference->labels + i;
    sum.flipped += v->flipped != v->end.label;
    sum.disagree += v->agrees == 0;
    sum.asked += v->agrees != 2;
    sum.mean_periods += (double)v->end.periods / (double)reference->samples;
  }
  return sum;
}
