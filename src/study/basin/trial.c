/* What `basin.boundary` and `basin.shocks` would take: a part of them is done and timed, with the attractors that a few starts end on. */
#include <math.h>
#include <stdlib.h>

#include "basin.h"
#include "boundary.h"
#include "attractors/catalogue.h"
#include "attractors/search.h"
#include "labelling/labeller.h"
#include "resilience/resilience.h"
#include "numerics/settling.h"
#include "labelling/starts.h"
#include "shocks_write.h"

enum {
  FEW = 1024, /* starts that the attractors are looked for from, at most */
  TILES = 16  /* of pairs that are timed */
};

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  kz_search search;
  double *state;  /* [search.starts][2] */
  int32_t *label; /* [search.starts] */
} trial;

static kz_status discover(trial *t) {
  const kz_scene *scene = t->scene;
  t->search = kz_search_of(scene);
  if (t->search.starts > FEW) t->search.starts = FEW;
  t->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, scene->basin.max_period);
  t->state = kz_malloc(2 * FEW * sizeof *t->state);
  t->label = kz_malloc(FEW * sizeof *t->label);
  if (!t->dynamics || !t->state || !t->label) return kz_fail(KZ_FAILED, "no memory to estimate the time");
  t->search.max_velocity = kz_dynamics_max_velocity(t->dynamics, &t->search.window);
  return kz_search_window(NULL, t->dynamics, &t->search, t->state, t->label);
}

/* A few starts end on attractors that were not found, and would be followed for ever. */
static kz_status try_boundary(const trial *t, double *seconds) {
  if (!t->scene->basin.has_boundary) return KZ_OK;
  kz_basin_plan plan = t->scene->basin;
  plan.max_periods = (int64_t)fmin((double)plan.max_periods, 8 * kz_settling_mean(t->scene->parameters.pendulum.beta));
  if (plan.method == KZ_METHOD_EXACT) kz_labeller_prepare(&(kz_labeller){.dynamics = t->dynamics});
  const double start = kz_processor_clock();
  for (int64_t tile = 0; tile < TILES; tile++) KZ_TRY(kz_boundary_try(&plan, t->dynamics, tile));
  *seconds += (kz_processor_clock() - start) / TILES * (double)kz_boundary_tiles(&plan);
  return KZ_OK;
}

/* The shocks of one strobe point, as many times as there are points that are not mirror images of others. */
static kz_status try_shocks(const trial *t, const kz_catalogue *catalogue, double *seconds) {
  const kz_resilience_plan plan = kz_shocks_asked(&t->scene->basin);
  int64_t n, own;
  if (!t->scene->basin.has_shocks) return KZ_OK;
  kz_resilience *point = kz_resilience_list(t->dynamics, catalogue, &n);
  const double start = kz_processor_clock();
  const kz_status status = kz_resilience_try(t->dynamics, &plan, n, point, &own);
  *seconds += (kz_processor_clock() - start) * (double)own;
  free(point);
  return status;
}

static kz_status time_parts(trial *t, double *seconds) {
  kz_catalogue catalogue = {0};
  KZ_TRY(discover(t));
  const int64_t known = kz_dynamics_count(t->dynamics);
  int64_t *reached = kz_calloc((size_t)known + 1, sizeof *reached);
  if (!reached) return kz_fail(KZ_FAILED, "no memory to estimate the time");
  for (int64_t i = 0; i < t->search.starts; i++) reached[t->label[i]]++;
  kz_dynamics_update(t->dynamics);
  kz_status status = try_boundary(t, seconds);
  kz_catalogue_make(t->dynamics, reached, &catalogue);
  if (status == KZ_OK) status = try_shocks(t, &catalogue, seconds);
  kz_catalogue_free(&catalogue);
  free(reached);
  return status;
}

kz_status kz_basin_try(const kz_scene *scene, double *seconds) {
  trial t = {.scene = scene};
  *seconds = 0;
  if (!(scene->parameters.pendulum.beta > 0) || !(scene->basin.has_boundary || scene->basin.has_shocks)) return KZ_OK;
  const kz_status status = time_parts(&t, seconds);
  if (t.dynamics) kz_dynamics_free(t.dynamics);
  free(t.state);
  free(t.label);
  return status;
}
