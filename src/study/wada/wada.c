/* Study `wada`: each side of each cycle of saddles is a tile. (H. E. Nusse, J. A. Yorke, Science 271 (1996) 1376; J. Kennedy, J. A. Yorke, Physica D
 * 51 (1991) 213.) */
#include "wada.h"

#include <stdlib.h>

#include "labelling/search.h"
#include "saddles/saddles.h"

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

/* The cycles that the study before has written, on every rank. Collective. */
static kz_status read_saddles(const kz_wada_plan *plan, const kz_run *run, kz_store *store, work *w) {
  KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_store_length(store, "saddles", "saddle", &w->n_saddles) : KZ_OK));
  KZ_TRY(kz_ranks_broadcast(run->ranks, &w->n_saddles, sizeof w->n_saddles));
  w->branch = kz_calloc((size_t)w->n_saddles + 1, sizeof *w->branch);
  w->twin = kz_calloc((size_t)w->n_saddles + 1, sizeof *w->twin);
  kz_status status = KZ_OK;
  for (int64_t i = 0; store && status == KZ_OK && i < w->n_saddles; i++) {
    double mirror = 0;
    kz_strobe_point at;
    status = kz_strobe_read(store, "saddles", i, 0, &at);
    w->branch[i] = (kz_branch){.theta = at.theta,
                               .velocity = at.velocity,
                               .period = (int32_t)at.period,
                               .spacing = plan->spacing,
                               .length = plan->length,
                               .fastest = plan->max_speed};
    if (status == KZ_OK) status = kz_store_number(store, "saddles", "mirror", &i, &mirror);
    w->twin[i] = mirror >= 0 && mirror < (double)i ? (int64_t)mirror : i;
  }
  KZ_TRY(kz_ranks_agree(run->ranks, status));
  KZ_TRY(kz_ranks_broadcast(run->ranks, w->twin, (size_t)(w->n_saddles + 1) * sizeof *w->twin));
  return kz_ranks_broadcast(run->ranks, w->branch, (size_t)(w->n_saddles + 1) * sizeof *w->branch);
}

/* Mirror images of others are left to reflect_branches. */
static kz_status side_tile(void *context, int64_t tile, void *record) {
  const work *w = context;
  if (w->twin[tile / SIDES] != tile / SIDES) return KZ_OK;
  kz_branch branch = w->branch[tile / SIDES];
  branch.side = tile % SIDES ? -1 : 1;
  return kz_branch_basins_find(&w->job, &branch, record);
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
  KZ_TRY(kz_file_attractors_match(run, store, w.job.dynamics, attractors));
  KZ_TRY(read_saddles(scene->wada, run, store, &w));
  return follow_branches(run, &w, store, summary);
}
