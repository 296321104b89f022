/* Study `escape`: each attractor with each saddle to which a path is sought is a tile. */
#include "cells/scene_search.h"
#include "counted.h"
#include "plane.h"
#include "report.h"
#include "saddles/saddles.h"

typedef struct {
  const kz_scene *scene;
  const kz_listed *attractors, *saddles;
  const kz_escape_task *task;
} work;

kz_cost kz_escape_cost(const kz_scene *scene) {
  const double pairs = 8 * kz_saddles_expected(scene), bytes = pairs * sizeof(kz_escape_route);
  return (kz_cost){.disk_bytes = 2 * bytes, .memory_bytes = sizeof(kz_escape_route), .rank0_bytes = bytes};
}

static bool find_cycle(const kz_escape_flow *flow, const kz_listed *list, int64_t id, bool attracts,
                       kz_escape_cycle *cycle) {
  const int64_t at = id * list->phases;
  return kz_escape_cycle_find(flow, (int64_t)list->period[id], attracts, list->theta + at, list->velocity + at, cycle);
}

/* Record: a kz_escape_route. */
static kz_status search_tile(void *context, int64_t tile, void *record) {
  const work *w = context;
  const kz_escape_task *task = w->task + tile;
  kz_escape_route *route = record;
  kz_escape_cycle from, to = {0};
  route->least.action = INFINITY;
  if (task->reflected) return KZ_OK;
  kz_escape_flow flow = kz_escape_flow_of(&w->scene->parameters.pendulum);
  if (find_cycle(&flow, w->attractors, task->from, true, &from) &&
      find_cycle(&flow, w->saddles, task->saddle, false, &to)) {
    kz_escape_search(&flow, &from, &to, w->scene->escape->starts, (uint64_t)(task->from * INT16_MAX + task->saddle),
                     route);
    if (route->count > 0 && !kz_escape_finish(&flow, &from, &to, KZ_ESCAPE_FINISHED, route))
      route->least.action = INFINITY;
  }
  kz_escape_cycle_free(&from);
  kz_escape_cycle_free(&to);
  kz_escape_flow_free(&flow);
  return KZ_OK;
}

/* Refuses lists of saddles that are known to be incomplete. Rank 0. */
static kz_status check_sums(kz_store *store) {
  int64_t n, open = 0;
  KZ_TRY(kz_store_length(store, "saddles", "sum", &n));
  KZ_AUTOFREE double *sum = kz_calloc((size_t)n + 1, sizeof *sum);
  KZ_TRY(kz_store_numbers(store, "saddles", "index_sum", n, sum));
  for (int64_t i = 0; i < n; i++) open += fabs(sum[i]) > 0;
  if (open == 0) return KZ_OK;
  return kz_fail(KZ_REFUSED,
                 "saddles|saddles.max_period: %lld of the index sums are not 0, so that saddles are missing through "
                 "which paths may lead; "
                 "give a larger window of velocities, or another max_period",
                 (long long)open);
}

/* Whether an attractor is left; KZ_REFUSED where the scene names one that is no cycle. */
static kz_status check_from(const kz_escape_plan *plan, const kz_listed *attractors) {
  if (attractors->count > KZ_GATE_ATTRACTORS)
    return kz_fail(KZ_REFUSED, "escape: there are %lld attractors; paths are sought between at most %d",
                   (long long)attractors->count, KZ_GATE_ATTRACTORS);
  for (int64_t i = 0; i < plan->from.count; i++) {
    const int64_t id = plan->from.values[i];
    if (id >= attractors->count)
      return kz_fail(KZ_REFUSED, "escape.from: there is no attractor %lld; there are %lld", (long long)id,
                     (long long)attractors->count);
    if (attractors->period[id] < 1)
      return kz_fail(KZ_REFUSED,
                     "escape.from: attractor %lld is no cycle; paths out of chaotic and running motions are not sought",
                     (long long)id);
  }
  return KZ_OK;
}

/* The tasks; the caller frees them. */
static kz_escape_task *list_tasks(const kz_escape_plan *plan, bool mirrored, const kz_listed *attractors,
                                  const kz_listed *saddles, const kz_gate *gate, int64_t *n) {
  kz_escape_task *task = kz_malloc((size_t)(attractors->count * saddles->count + 1) * sizeof *task);
  const uint64_t alone = kz_gates_alone(saddles->count, gate);
  *n = 0;
  for (int64_t a = 0; a < attractors->count; a++)
    for (int64_t s = 0; kz_escape_is_left(plan, attractors, a) && s < saddles->count; s++) {
      const bool is_gate = kz_gate_is_of(gate + s, (int32_t)a, alone);
      bool is_sought = is_gate;
      for (int32_t b = 0; plan->everywhere && b < (int32_t)attractors->count; b++)
        is_sought = is_sought || kz_gate_is_of(gate + s, b, alone);
      /* Far paths are sought once and reflected; those through gates set lives and are compared with their images */
      const int64_t image_a = (int64_t)attractors->mirror[a], image_s = (int64_t)saddles->mirror[s];
      const bool reflected = !is_gate && mirrored && (image_a != a ? image_a < a : image_s < s) &&
                             kz_escape_is_left(plan, attractors, image_a);
      if (is_sought)
        task[(*n)++] = (kz_escape_task){.from = (int32_t)a,
                                        .saddle = (int32_t)s,
                                        .is_gate = is_gate,
                                        .reflected = reflected,
                                        .into = -1,
                                        .before = -1};
    }
  return task;
}

/* Follows each path's last state, moved to the other side of the saddle and to this side. Collective. */
static kz_status escape_release(const kz_escape_labels *labels, const kz_gate *gate, int64_t n,
                                const kz_escape_route *route, kz_escape_task *task) {
  KZ_AUTOFREE double (*start)[2] = kz_calloc((size_t)(2 * n) + 1, sizeof *start);
  KZ_AUTOFREE int32_t *id = kz_calloc((size_t)(2 * n) + 1, sizeof *id);
  for (int64_t i = 0; route && i < n; i++)
    kz_escape_beyond(route + i, gate + task[i].saddle, start[2 * i], start[2 * i + 1]);
  KZ_TRY(kz_ranks_broadcast(labels->run->ranks, start, (size_t)(2 * n) * sizeof *start));
  KZ_TRY(kz_escape_label(labels, 1, 2 * n, start[0], id));
  for (int64_t i = 0; i < n; i++) task[i].before = id[2 * i], task[i].into = id[2 * i + 1];
  return KZ_OK;
}

static kz_status run_tasks(const kz_scene *scene, const kz_run *run, const kz_escape_labels *labels,
                           const kz_listed *attractors, const kz_listed *saddles, kz_store *store, FILE *summary) {
  const kz_escape_plan *plan = scene->escape;
  kz_escape_flow flow = kz_escape_flow_of(&scene->parameters.pendulum);
  KZ_AUTOFREE kz_gate *gate = kz_calloc((size_t)saddles->count + 1, sizeof *gate);
  kz_status status = kz_gates_find(labels, &flow, saddles, gate);
  kz_escape_flow_free(&flow);
  KZ_TRY(status);
  if (kz_is_mirrored(&scene->parameters.pendulum)) kz_gates_pair(attractors, saddles, gate);
  int64_t n;
  KZ_AUTOFREE kz_escape_task *task =
      list_tasks(plan, kz_is_mirrored(&scene->parameters.pendulum), attractors, saddles, gate, &n);
  work w = {scene, attractors, saddles, task};
  const kz_stage stage = kz_stage_for_rank0("escape", n, sizeof(kz_escape_route), search_tile, &w);
  KZ_AUTOFREE kz_escape_route *route = store ? kz_calloc((size_t)n + 1, sizeof *route) : NULL;
  KZ_TRY(kz_stage_run(run, &stage, route));
  KZ_TRY(escape_release(labels, gate, n, route, task));
  const kz_escape_report report = {scene, attractors, saddles, gate, n, task, route};
  return kz_ranks_agree(run->ranks, store ? kz_escape_write(&report, store, summary) : KZ_OK);
}

kz_status kz_escape_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_search search = kz_search_of(scene);
  KZ_AUTOFREE_BY(kz_listed_free) kz_listed attractors = {0};
  KZ_AUTOFREE_BY(kz_listed_free) kz_listed saddles = {0};
  KZ_TRY(kz_ranks_agree(run->ranks, store ? check_sums(store) : KZ_OK));
  KZ_TRY(kz_listed_read(run, store, "attractors", "attractor", &attractors));
  KZ_TRY(kz_listed_read(run, store, "saddles", "saddle", &saddles));
  KZ_TRY(check_from(scene->escape, &attractors));
  KZ_AUTOFREE_BY(kz_dynamics_freed) kz_dynamics *dynamics = kz_search_dynamics(scene);
  KZ_AUTOFREE kz_escape_labels *labels = kz_calloc(1, sizeof *labels);
  *labels = (kz_escape_labels){.run = run, .dynamics = dynamics, .max_periods = search.max_periods};
  KZ_TRY(kz_escape_labels_make(&search, &attractors, labels));
  KZ_TRY(run_tasks(scene, run, labels, &attractors, &saddles, store, summary));
  KZ_TRY(kz_escape_over_plane(scene, labels, &attractors, store, summary));
  return kz_escape_count(scene, run, &attractors, store, summary);
}
