/* A stage whose tiles are points: each process measures its own pendulums. */
#include "points.h"

#include <math.h>
#include <string.h>

#include "labelling/labeller.h"

kz_cost kz_points_cost(const kz_scene *scene) {
  const kz_points points = kz_points_of(scene);
  const double n = (double)(points.columns * points.rows), bytes = n * (double)kz_point_bytes(&points);
  return (kz_cost){.cells = (int64_t)n * points.plan.starts,
                   .disk_bytes = 1.5 * bytes,
                   .memory_bytes = bytes,
                   .rank0_bytes = bytes + n * KZ_POINT_MOST * 40};
}

/* The values of all measures, side by side for each attractor. */
static void fill(const kz_points *points, const kz_measured *measured, kz_measured_point *out) {
  const int64_t n = measured->catalogue.count;
  KZ_FREED double *value = kz_malloc((size_t)(3 * n + 1) * sizeof *value);
  int64_t number = 0, of_pendulum = 0;
  for (int64_t i = 0; i < points->plan.names.count; i++) {
    const kz_measure *measure = kz_measures + points->plan.names.values[i];
    measure->fill(measured, value);
    if (measure->shape == KZ_PER_PENDULUM) {
      out->value[KZ_POINT_MOST * points->numbers + of_pendulum++] = value[0];
      continue;
    }
    for (int part = 0; part < (measure->shape == KZ_PER_INTERVAL ? 3 : 1); part++, number++)
      for (int64_t id = 0; id < n; id++) out->value[id * points->numbers + number] = value[part * n + id];
  }
}

static kz_status measure_point(void *context, int64_t tile, void *record) {
  const kz_points *points = context;
  kz_measured_point *out = record;
  kz_pendulum pendulum;
  out->count = -1;
  if (!kz_points_pendulum(points, tile, tile, 0, &pendulum) || !(pendulum.beta > 0)) return KZ_OK;
  KZ_FREED_BY(kz_measured_free) kz_measured measured = {0};
  KZ_TRY(kz_measured_make(&pendulum, &points->scene->numerics, &points->plan, KZ_BY_STATES,
                          kz_measures_need(&points->plan.names), NULL, &measured));
  if (measured.catalogue.count > KZ_POINT_MOST)
    return kz_fail(KZ_FAILED, "sweep: more than %d attractors at one point; use more damping or a smaller window",
                   KZ_POINT_MOST);
  out->count = measured.catalogue.count;
  for (int64_t id = 0; id < out->count; id++) {
    const kz_entry *entry = measured.catalogue.entries + id;
    out->attractor[id] = kz_branch_point_of(&entry->row, entry->theta[0], entry->velocity[0]);
  }
  fill(points, &measured, out);
  return KZ_OK;
}

kz_status kz_points_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_points points = kz_points_of(scene);
  const kz_stage stage =
      kz_stage_for_all("points", points.columns * points.rows, kz_point_bytes(&points), measure_point, (void *)&points);
  KZ_FREED void *records = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  KZ_FREED_BY(kz_classes_free) kz_classes classes = {0};
  KZ_TRY(kz_stage_run(run, &stage, records));
  KZ_TRY(kz_classes_make(&points, run, records, &classes));
  return kz_ranks_agree(run->ranks, store ? kz_points_write(&points, records, &classes, store, summary) : KZ_OK);
}
