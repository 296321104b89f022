/* Study `tangency`: one tile. */
#include <math.h>
#include <stdlib.h>

#include "kapitza/study_keys.h"
#include "saddles/saddles.h"
#include "search.h"
#include "sweep/sweep.h"

/* rad: the manifold leaves its tangent by the square of this. */
static const double NEARNESS = 1e-7;

typedef struct {
  kz_tangency_search search;
  int64_t saddle[2];
} work;
typedef struct {
  kz_tangency found;
  kz_touch touch;
} record;

kz_cost kz_tangency_cost(const kz_scene *scene) {
  (void)scene;
  return (kz_cost){.disk_bytes = 1e4, .memory_bytes = 1e7};
}

static kz_status find(void *context, int64_t tile, void *out) {
  work *w = context;
  record *r = out;
  (void)tile;
  KZ_TRY(kz_tangency_find(&w->search, &r->found));
  r->touch = w->search.touch;
  return KZ_OK;
}

/* The orbit through the point of contact, a state for each return to either cycle; strobe counts drive periods from there. */
static kz_status write_orbit(const kz_arm arm[2], const kz_touch *touch, kz_store *store) {
  const int64_t before = (int64_t)floor(touch->from_place), after = (int64_t)floor(touch->into_place), n = before + after + 1;
  KZ_FREED kz_arm_point *point = kz_malloc((size_t)n * sizeof *point);
  KZ_FREED int32_t *strobe = kz_malloc((size_t)n * sizeof *strobe);
  for (int64_t i = 0; i < n; i++) {
    const int64_t j = i - before;
    const double place = j <= 0 ? touch->from_place + (double)j : touch->into_place - (double)j;
    kz_arm_points(arm + (j > 0), 1, &place, point + i);
    strobe[i] = (int32_t)j * arm[j > 0].periods;
  }
  KZ_TRY(kz_store_dimension(store, "tangency", "strobe", n, strobe));
  KZ_COLUMN(store, "tangency", "theta", n, double, point[i].theta >= M_PI ? -M_PI : point[i].theta + 0.0);
  KZ_COLUMN(store, "tangency", "velocity", n, double, point[i].velocity + 0.0);
  return KZ_OK;
}

static kz_status write(work *w, const record *r, kz_store *store, FILE *summary) {
  const kz_tangency_plan *plan = w->search.scene->tangency;
  const char *unit = kz_axis_unit(&plan->axis.values, plan->axis.parameter);
  kz_arm arm[2];
  KZ_TRY(kz_axis_describe(&plan->axis.values, plan->axis.parameter, "", "tangency", store));
  KZ_TRY(kz_store_real(store, "tangency", "value", r->found.value));
  KZ_TRY(kz_store_real(store, "tangency", "error", r->found.error));
  KZ_TRY(kz_store_text(store, "tangency", "crossing", r->found.above ? "above" : "below"));
  KZ_TRY(kz_store_integer(store, "tangency", "saddle", w->saddle[0]));
  KZ_TRY(kz_store_integer(store, "tangency", "into", w->saddle[1]));
  if (!kz_tangency_arms(&w->search, r->found.value, &r->touch, arm)) return kz_fail(KZ_FAILED, "tangency: a cycle is lost");
  const kz_status status = write_orbit(arm, &r->touch, store);
  kz_arm_free(arm);
  kz_arm_free(arm + 1);
  fprintf(summary,
          "tangency: the unstable manifold of cycle %lld touches the stable one of cycle %lld at %s = %.14g (+- %.1g)%s%s; "
          "they cross "
          "%s it.\n",
          (long long)w->saddle[0], (long long)w->saddle[1], kz_sweep_parameter_at(plan->axis.parameter)->name,
          kz_axis_written(&plan->axis.values, r->found.value), kz_axis_written(&plan->axis.values, r->found.error),
          unit[0] ? " " : "", unit, r->found.above ? "above" : "below");
  return status;
}

/* A cycle of the group saddles. */
static kz_status hinge_of(const kz_listed *saddles, int64_t saddle, kz_hinge *hinge) {
  KZ_TRY(kz_saddle_check(saddles, "tangency.saddle|saddles", saddle));
  hinge->period = (int32_t)saddles->period[saddle];
  for (int32_t i = 0; i < hinge->period; i++) {
    hinge->theta[i] = saddles->theta[saddle * saddles->phases + i];
    hinge->velocity[i] = saddles->velocity[saddle * saddles->phases + i];
  }
  return KZ_OK;
}

/* Both cycles, on every rank. Collective. */
static kz_status read_hinges(const kz_run *run, kz_store *store, work *w) {
  KZ_FREED_BY(kz_listed_free) kz_listed saddles;
  KZ_TRY(kz_listed_read(run, store, "saddles", "saddle", &saddles));
  KZ_TRY(kz_ranks_agree(run->ranks, hinge_of(&saddles, w->saddle[0], &w->search.from)));
  return kz_ranks_agree(run->ranks, hinge_of(&saddles, w->saddle[1], &w->search.into));
}

kz_status kz_tangency_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_tangency_plan *plan = scene->tangency;
  const char *const written = (const char *)&scene->parameters.written;
  work w = {.search = {.scene = scene,
                       .value = *(const double *)(written + kz_sweep_parameter_at(plan->axis.parameter)->offset),
                       .nearness = NEARNESS},
            .saddle = {plan->saddle, plan->into == KZ_UNSET_INTEGER ? plan->saddle : plan->into}};
  const kz_stage stage = kz_stage_for_rank0("tangency", 1, sizeof(record), find, &w);
  record r = {0};
  KZ_TRY(read_hinges(run, store, &w));
  KZ_TRY(kz_stage_run(run, &stage, &r));
  return store ? write(&w, &r, store, summary) : KZ_OK;
}
