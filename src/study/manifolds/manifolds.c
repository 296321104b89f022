/* Study `manifolds`: every branch of the chosen cycles is a tile. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "saddles/saddles.h"
#include "saddles/plan.h"
#include "plan.h"

typedef struct {
  int64_t saddle, number; /* number: 2 * place of the strobe point, + 1 for the other side */
  kz_branch branch;
} task;

typedef struct {
  const kz_pendulum *pendulum;
  int64_t count;
  task *tasks;
} work_list;

enum { POINT_BYTES = 4 * sizeof(double), FILE_BYTES = 50 /* of a point in the file */, PAGE_BYTES = 4096 };

/* The record of a branch. */
typedef struct {
  uint64_t bytes; /* in use */
  double point[4 * KZ_BRANCH_POINTS];
} grown;

/* The points of a branch, on rank 0. */
typedef struct {
  int64_t count;
  double *point; /* [count][4] */
} line;

/* Branches of the chosen cycles; of those that are not yet known, most have the longest period. */
kz_cost kz_manifolds_cost(const kz_scene *scene) {
  const kz_manifolds_plan *plan = scene->manifolds;
  const double saddles = plan->saddles.count > 0 ? (double)plan->saddles.count : kz_saddles_expected(scene);
  const double kinds = plan->kind == KZ_MANIFOLDS_STABLE || plan->kind == KZ_MANIFOLDS_UNSTABLE ? 1 : 2;
  const double branches = 2 * kinds * saddles * (double)scene->saddles->max_period;
  const double points = fmin(2 * plan->length / plan->spacing, KZ_BRANCH_POINTS), kept = PAGE_BYTES + POINT_BYTES * points;
  return (kz_cost){.disk_bytes = branches * (kept + FILE_BYTES * points),
                   .memory_bytes = 2 * sizeof(grown),
                   .rank0_bytes = branches * (POINT_BYTES + sizeof(void *) + 4) * points,
                   .shared_bytes = branches * kept};
}

static void free_tasks(work_list *list) {
  free(list->tasks);
}

/* The branches of one cycle join the list. */
static void add_saddle(const kz_manifolds_plan *plan, int64_t saddle, const kz_listed *known, work_list *list) {
  const int32_t period = (int32_t)known->period[saddle];
  list->tasks = kz_realloc(list->tasks, (size_t)(list->count + 4 * period) * sizeof *list->tasks);
  for (int64_t phase = 0; phase < period; phase++) {
    const int64_t at = saddle * known->phases + phase;
    for (int i = 0; i < 4; i++) {
      const kz_branch branch = {known->theta[at], known->velocity[at], period,       i / 2,
                                i % 2 ? -1 : 1,   plan->spacing,       plan->length, plan->max_speed};
      if (plan->kind == (branch.stable ? KZ_MANIFOLDS_UNSTABLE : KZ_MANIFOLDS_STABLE)) continue;
      list->tasks[list->count++] = (task){.saddle = saddle, .number = 2 * phase + i % 2, .branch = branch};
    }
  }
}

/* The branches that the scene asks for, of the cycles that the study before has written. Collective. */
static kz_status make_tasks(const kz_manifolds_plan *plan, const kz_run *run, kz_store *store, work_list *list) {
  KZ_FREED_BY(kz_listed_free) kz_listed known;
  KZ_TRY(kz_listed_read(run, store, "saddles", "saddle", &known));
  const int64_t n = plan->saddles.count > 0 ? plan->saddles.count : known.count;
  for (int64_t i = 0; i < n; i++) {
    const int64_t saddle = plan->saddles.count > 0 ? plan->saddles.values[i] : i;
    KZ_TRY(kz_ranks_agree(run->ranks, kz_saddle_check(&known, "manifolds.saddles", saddle)));
    add_saddle(plan, saddle, &known, list);
  }
  return KZ_OK;
}

static kz_status grow(void *context, int64_t tile, void *record) {
  const work_list *list = context;
  grown *out = record;
  out->bytes = offsetof(grown, point) + POINT_BYTES * (uint64_t)kz_manifold_grow(list->pendulum, &list->tasks[tile].branch,
                                                                                 KZ_BRANCH_POINTS, out->point);
  return KZ_OK;
}

static kz_status take(void *context, int64_t tile, const void *record, size_t bytes) {
  const grown *in = record;
  const size_t used = bytes - offsetof(grown, point);
  line *of = (line *)context + tile;
  *of = (line){.count = (int64_t)(used / POINT_BYTES), .point = kz_malloc(used + 1)};
  memcpy(of->point, in->point, used);
  return KZ_OK;
}

/* Grows all branches; lines [count] on rank 0. Collective. */
static kz_status grow_all(const kz_run *run, work_list *list, line *lines) {
  const kz_stage stage = {
      .name = "manifolds", .n_tiles = list->count, .record_bytes = sizeof(grown), .work = grow, .context = list, .keep = true};
  return kz_stage_gather(run, &stage, "manifolds: points", take, lines);
}

/* A point of the file. */
typedef struct {
  const task *of;
  const double *point;
  int32_t polyline;
} row;

static row *rows_of(const work_list *list, const line *lines, int64_t *n) {
  *n = 0;
  for (int64_t i = 0; i < list->count; i++) *n += lines[i].count;
  row *rows = kz_malloc((size_t)(*n + 1) * sizeof *rows);
  int64_t at = 0;
  int32_t polyline = -1;
  for (int64_t i = 0; i < list->count; i++) {
    for (int64_t j = 0; j < lines[i].count; j++) {
      const double *point = lines[i].point + 4 * j;
      if (j == 0 || point[3] != point[-1]) polyline++;
      rows[at++] = (row){list->tasks + i, point, polyline};
    }
  }
  return rows;
}

#define COLUMN(type, name, expression) KZ_COLUMN(store, "manifolds", name, n, type, expression)

static kz_status write_rows(int64_t n, const row *rows, kz_store *store) {
  KZ_TRY(kz_store_dimension(store, "manifolds", "point", n, NULL));
  COLUMN(double, "theta", rows[i].point[0]);
  COLUMN(double, "velocity", rows[i].point[1]);
  COLUMN(double, "arc_length", rows[i].point[2]);
  COLUMN(int32_t, "saddle", rows[i].of->saddle);
  COLUMN(int32_t, "branch", rows[i].of->number);
  COLUMN(int8_t, "kind", rows[i].of->branch.stable);
  COLUMN(int32_t, "polyline", rows[i].polyline);
  return KZ_OK;
}

static void print(const kz_manifolds_plan *plan, const work_list *list, const line *lines, int64_t n, FILE *summary) {
  int64_t shorter = 0, full = 0;
  for (int64_t i = 0; i < list->count; i++) {
    const double *last = lines[i].point + 4 * (lines[i].count - 1);
    full += lines[i].count == KZ_BRANCH_POINTS;
    shorter += lines[i].count < KZ_BRANCH_POINTS && last[2] < plan->length;
  }
  fprintf(summary, "manifolds: %lld branches, %lld points\n", (long long)list->count, (long long)n);
  if (shorter > 0)
    fprintf(
        summary,
        "%lld branches end before length = %g: they lead to an attractor, or beyond max_speed = %g, or stretch so much that "
        "double precision does not resolve them\n",
        (long long)shorter, plan->length, plan->max_speed);
  if (full > 0)
    fprintf(summary, "%lld branches end at %d points before length = %g; give a larger spacing\n", (long long)full,
            KZ_BRANCH_POINTS, plan->length);
}

static kz_status write(const kz_scene *scene, const work_list *list, const line *lines, kz_store *store, FILE *summary) {
  int64_t n;
  KZ_FREED row *rows = rows_of(list, lines, &n);
  KZ_TRY(write_rows(n, rows, store));
  print(scene->manifolds, list, lines, n, summary);
  return KZ_OK;
}

kz_status kz_manifolds_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_FREED_BY(free_tasks) work_list list = {.pendulum = &scene->parameters.pendulum};
  KZ_TRY(make_tasks(scene->manifolds, run, store, &list));
  KZ_FREED line *lines = kz_calloc((size_t)list.count + 1, sizeof *lines);
  kz_status status = list.count > 0 ? grow_all(run, &list, lines) : KZ_OK;
  if (status == KZ_OK && store) status = write(scene, &list, lines, store, summary);
  for (int64_t i = 0; i < list.count; i++) free(lines[i].point);
  return status;
}
