/* Study `wada`: each side of each cycle of saddles is a tile. (H. E. Nusse, J. A. Yorke, Science 271 (1996) 1376; J. Kennedy, J. A. Yorke, Physica D
 * 51 (1991) 213.) */
#include "wada.h"

#include <math.h>
#include <stdlib.h>

#include "cells/scene_search.h"
#include "saddles/saddles.h"
#include "labelling/labeller.h"
#include "labelling/listed.h"

/* ---- where the points of a branch of an unstable manifold end ---- */

/* rad: bound of the distance of a computed point from the manifold, which shrinks along it; docs/explanation/boundaries.md. */
static const double OFF = 1e-11;
/* rad: nearer to the cycle, points are not labelled, because OFF counts there; the others contain their images. */
static const double BESIDE = 1e-6;

/* A kz_start_fn: the items are points of a branch, with their error. */
static kz_status start_of_point(void *context, int64_t item, kz_precision level, kz_start *start) {
  const double *point = (const double *)context + 4 * item;
  (void)level;
  *start = kz_start_at(point[0], point[1]);
  start->error[0] = start->error[2] = OFF * OFF;
  return KZ_OK;
}

/* Whether all points end on one attractor, and the last one is in its trapping region. */
static bool is_followed(int64_t n, const kz_label *label) {
  if (n < 1 || label[n - 1].label <= 0 || label[n - 1].periods > 0) return false;
  for (int64_t i = 0; i < n; i++)
    if (label[i].label != label[n - 1].label) return false;
  return true;
}

/* Of each basin the point that settles first. */
static void find_witnesses(const kz_file_attractors *attractors, int64_t n, const double *point, const kz_label *label,
                           kz_witness *witness) {
  for (int64_t i = 0; i < attractors->count; i++) witness[i] = (kz_witness){NAN, NAN, NAN, NAN};
  for (int64_t i = 0; i < n; i++) {
    const int32_t id = label[i].label > 0 ? attractors->id[label[i].label] : -1;
    if (id < 0 || label[i].periods >= witness[id].periods) continue;
    const double *at = point + 4 * i;
    witness[id] = (kz_witness){at[0], at[1], at[2], label[i].periods};
  }
}

/* Grows the branch, labels its points at the first level of precision, and notes where they end. */
static kz_status find_basins(const kz_wada_job *job, const kz_branch *branch, kz_branch_basins *basins) {
  KZ_FREED double *all = kz_malloc(4 * KZ_BRANCH_POINTS * sizeof *all);
  double *point = all;
  KZ_FREED kz_label *label = kz_calloc(KZ_BRANCH_POINTS, sizeof *label);
  int64_t n = kz_manifold_grow(&job->scene->parameters.pendulum, branch, KZ_BRANCH_POINTS, point);
  for (; n > 0 && point[2] < BESIDE; n--) point += 4;
  const kz_labeller labeller = {job->dynamics, job->max_periods, KZ_BY_LEVELS,    KZ_OPEN_DOUBTFUL,
                                true,          start_of_point,   .context = point};
  KZ_TRY(kz_label_first(&labeller, n, NULL, label));
  basins->followed = is_followed(n, label);
  find_witnesses(job->attractors, n, point, label, basins->witness);
  return KZ_OK;
}

/* ---- attractors of kz_dynamics and their ids in the file ---- */

/* Gives every attractor of `dynamics` its id in the group attractors of the file; cycles of the file that it lacks join it. Collective; store NULL on
 * all ranks but rank 0. */
static kz_status match_attractors(const kz_run *run, kz_store *store, kz_dynamics *dynamics, kz_file_attractors *attractors) {
  KZ_FREED_BY(kz_listed_free) kz_listed list;
  KZ_TRY(kz_listed_read(run, store, "attractors", "attractor", &list));
  const int64_t known = kz_dynamics_count(dynamics);
  for (int64_t i = 0, at = 0; i < list.count; i++, at += list.phases)
    if (list.period[i] > 0) kz_dynamics_add_cycle(dynamics, (int64_t)list.period[i], list.theta[at], list.velocity[at]);
  if (kz_dynamics_count(dynamics) > known) kz_dynamics_update(dynamics);
  attractors->count = list.count;
  for (int64_t row = 0; row < list.count; row++) attractors->mirror[row] = (int32_t)list.mirror[row];
  kz_listed_match(dynamics, &list, attractors->id);
  return KZ_OK;
}

enum { SIDES = 2, PAGE_BYTES = 4096, MOST_ATTRACTORS = 64 /* of the estimate */ };

typedef struct {
  kz_wada_job job;
  int64_t n_saddles;
  kz_branch *branch; /* [n_saddles] */
  int64_t *twin;     /* [n_saddles] the mirror image, if its id is lower; else the cycle itself */
} work;

static size_t record_bytes(int64_t n_attractors) {
  return sizeof(kz_branch_basins) + (size_t)n_attractors * sizeof(kz_witness);
}

kz_cost kz_wada_cost(const kz_scene *scene) {
  const double saddles = kz_saddles_expected(scene), record = (double)record_bytes(MOST_ATTRACTORS);
  const double point = 4 * sizeof(double) + 64; /* and its label */
  return (kz_cost){.disk_bytes = SIDES * saddles * (PAGE_BYTES + record),
                   .memory_bytes = KZ_BRANCH_POINTS * point + saddles * sizeof(kz_branch),
                   .rank0_bytes = SIDES * saddles * record};
}

/* The cycles that the study before has written. Collective. */
static kz_status read_saddles(const kz_wada_plan *plan, const kz_run *run, kz_store *store, work *w) {
  KZ_FREED_BY(kz_listed_free) kz_listed list;
  KZ_TRY(kz_listed_read(run, store, "saddles", "saddle", &list));
  const bool mirrored = kz_is_mirrored(&w->job.scene->parameters.pendulum);
  w->n_saddles = list.count;
  w->branch = kz_calloc((size_t)list.count + 1, sizeof *w->branch);
  w->twin = kz_calloc((size_t)list.count + 1, sizeof *w->twin);
  for (int64_t i = 0; i < list.count; i++) {
    w->branch[i] = (kz_branch){.theta = list.theta[i * list.phases],
                               .velocity = list.velocity[i * list.phases],
                               .period = (int32_t)list.period[i],
                               .spacing = plan->spacing,
                               .length = plan->length,
                               .fastest = plan->max_speed};
    w->twin[i] = mirrored && list.mirror[i] >= 0 && list.mirror[i] < (double)i ? (int64_t)list.mirror[i] : i;
  }
  return KZ_OK;
}

/* Mirror images of others are left to reflect_branches. */
static kz_status side_tile(void *context, int64_t tile, void *record) {
  const work *w = context;
  if (w->twin[tile / SIDES] != tile / SIDES) return KZ_OK;
  kz_branch branch = w->branch[tile / SIDES];
  branch.side = tile % SIDES ? -1 : 1;
  return find_basins(&w->job, &branch, record);
}

static void reflect(const kz_file_attractors *attractors, const kz_branch_basins *from, kz_branch_basins *to) {
  to->followed = from->followed;
  for (int64_t i = 0; i < attractors->count; i++) {
    const kz_witness *w = from->witness + i;
    to->witness[attractors->mirror[i]] = (kz_witness){-w->theta, -w->velocity, w->arc_length, w->periods};
  }
}

/* The branches of cycles whose mirror images have lower ids. */
static void reflect_branches(const work *w, size_t stride, char *basins) {
  for (int64_t i = 0; i < SIDES * w->n_saddles; i++) {
    const int64_t twin = w->twin[i / SIDES];
    if (twin == i / SIDES) continue;
    reflect(w->job.attractors, (const kz_branch_basins *)(basins + (size_t)(SIDES * twin + i % SIDES) * stride),
            (kz_branch_basins *)(basins + (size_t)i * stride));
  }
}

static kz_status follow_branches(const kz_run *run, work *w, kz_store *store, FILE *summary) {
  const size_t stride = record_bytes(w->job.attractors->count);
  const int64_t n = SIDES * w->n_saddles;
  const kz_stage stage = kz_stage_for_rank0("wada", n, stride, side_tile, w);
  KZ_FREED void *basins = kz_calloc((size_t)n + 1, stride);
  KZ_TRY(kz_stage_run(run, &stage, basins));
  if (!store) return KZ_OK;
  reflect_branches(w, stride, basins);
  return kz_wada_write(w->n_saddles, w->job.attractors->count, basins, stride, store, summary);
}

static void release(work *w) {
  kz_dynamics_free(w->job.dynamics);
  free(w->branch);
  free(w->twin);
}

kz_status kz_wada_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_search search = kz_search_of(scene);
  KZ_FREED kz_file_attractors *attractors = kz_calloc(1, sizeof *attractors);
  KZ_FREED_BY(release) work w = {.job = {scene, kz_search_dynamics(scene), attractors, search.max_periods}};
  KZ_TRY(kz_search_window(run, w.job.dynamics, &search, NULL));
  KZ_TRY(match_attractors(run, store, w.job.dynamics, attractors));
  KZ_TRY(read_saddles(scene->wada, run, store, &w));
  return follow_branches(run, &w, store, summary);
}
