/* Bifurcation diagram: the strobe points after a transient, once with the values going up and once down. Each walk carries its
 * state from value to value, so that it shows where attractors are lost and not found again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sweep.h"

enum { WALKS = 2 };
/* rad: a motion that has come to rest is pushed this much at each value, or rounding would hold it where it is no longer
 * stable. */
static const double PUSH = 1e-6;

/* One walk: [values][2][samples] angles, then velocities, in the order of the values. */
static kz_status work(void *context, int64_t tile, void *record) {
  const kz_scene *scene = context;
  const kz_sweep_plan *plan = &scene->sweep;
  const int64_t values = plan->values.count;
  double theta = plan->start_theta, velocity = plan->start_velocity;
  for (int64_t step = 0; step < values; step++) {
    const int64_t i = tile == 0 ? step : values - 1 - step;
    double *out = (double *)record + i * 2 * plan->samples;
    kz_pendulum pendulum;
    int64_t turns = 0;
    if (!kz_sweep_pendulum(scene, kz_sweep_value(plan, i), &pendulum)) continue;
    kz_plan *map = kz_plan_create(&pendulum, &scene->numerics);
    if (!map) return kz_fail(KZ_FAILED, "no memory for the strobe points of a sweep");
    theta += PUSH;
    kz_advance(map, 1, plan->transient, &theta, &velocity, &turns);
    for (int64_t s = 0; s < plan->samples; s++) {
      kz_advance(map, 1, 1, &theta, &velocity, &turns);
      out[s] = theta >= M_PI ? -M_PI : theta;
      out[plan->samples + s] = velocity;
    }
    kz_plan_free(map);
  }
  return KZ_OK;
}

/* The walks side by side: [values][up, then down]. */
static kz_status write_strobe(const kz_scene *scene, const void *records, kz_store *store, FILE *summary) {
  const double *points = records;
  const int64_t values = scene->sweep.values.count, samples = scene->sweep.samples, all = WALKS * samples;
  double *theta = malloc((size_t)(values * all) * sizeof *theta), *velocity = malloc((size_t)(values * all) * sizeof *velocity);
  int8_t *walk = malloc((size_t)all);
  kz_status status = theta && velocity && walk ? KZ_OK : kz_fail(KZ_FAILED, "no memory for the strobe points of a sweep");
  for (int64_t i = 0; status == KZ_OK && i < WALKS * values; i++) {
    const int64_t at = (i % values) * all + (i / values) * samples;
    memcpy(theta + at, points + i * 2 * samples, (size_t)samples * sizeof *theta);
    memcpy(velocity + at, points + (i * 2 + 1) * samples, (size_t)samples * sizeof *velocity);
  }
  for (int64_t s = 0; status == KZ_OK && s < all; s++) walk[s] = (int8_t)(s / samples);
  if (status == KZ_OK) status = kz_store_dimension(store, "sweep", "sample", all, NULL);
  if (status == KZ_OK) status = kz_store_variable(store, "sweep", "sample_walk", walk);
  if (status == KZ_OK) status = kz_store_variable(store, "sweep", "strobe_theta", theta);
  if (status == KZ_OK) status = kz_store_variable(store, "sweep", "strobe_velocity", velocity);
  free(theta);
  free(velocity);
  free(walk);
  fprintf(summary, "strobe points of %lld periods at each value, up and down\n", (long long)samples);
  return status;
}

kz_status kz_sweep_strobe(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary) {
  const size_t bytes = (size_t)(scene->sweep.values.count * 2 * scene->sweep.samples) * sizeof(double);
  const kz_stage stage = {.name = "sweep strobe", .n_tiles = WALKS, .record_bytes = bytes, .work = work};
  return kz_sweep_stage(scene, team, &stage, write_strobe, store, summary);
}
