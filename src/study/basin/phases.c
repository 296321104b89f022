/* The share of a window that ends on the same attractor whatever the phase of release: the file's group /phases, and its part of the summary. */
#include <stdlib.h>

#include "basin.h"
#include "labelling/phases.h"

/* The id in the file; -1 = none. */
static int32_t id_at(const kz_catalogue *catalogue, int16_t number) {
  return number > 0 ? catalogue->id_of[number] : -1;
}

static double share_of(const kz_phases *p, const kz_catalogue *catalogue, int64_t phase, int64_t id) {
  int64_t count = 0;
  for (int64_t cell = 0; cell < p->n; cell++) count += id_at(catalogue, kz_phases_at(p, phase, cell)) == id;
  return (double)count / (double)p->n;
}

static kz_status write_group(const kz_basin_plan *plan, const kz_phases *p, const kz_catalogue *catalogue, kz_store *store,
                             FILE *summary) {
  const int64_t known = catalogue->count;
  int64_t alike = 0;
  KZ_SCALE(store, "phases", "phase", p->phases, kz_phase_at(p, i));
  KZ_SCALE(store, "phases", "velocity", plan->velocity.count, kz_axis_centre(&plan->velocity, i));
  KZ_SCALE(store, "phases", "theta", plan->theta.count, kz_axis_centre(&plan->theta, i));
  KZ_TRY(kz_store_dimension(store, "phases", "attractor", known, NULL));
  KZ_COLUMN(store, "phases", "fraction", p->phases * known, double, share_of(p, catalogue, i / known, i % known));
  KZ_COLUMN(store, "phases", "common", p->n, int16_t, id_at(catalogue, kz_phases_common(p, i)));
  KZ_COLUMN(store, "phases", "ends", p->n, uint8_t, kz_phases_ends(p, i));
  for (int64_t cell = 0; cell < p->n; cell++) alike += kz_phases_common(p, cell) > 0;
  fprintf(summary, "Released at %lld phases of the drive, %.4g %% of the cells end alike at all of them.\n",
          (long long)p->phases, 100.0 * (double)alike / (double)p->n);
  return kz_store_real(store, "phases", "share", (double)alike / (double)p->n);
}

kz_status kz_phases_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                         kz_store *store, FILE *summary) {
  if (scene->basin->phases <= 0) return KZ_OK;
  kz_phases p = {.labeller = kz_cell_labeller(scene->basin, labelling->dynamics),
                 .release = scene->parameters.release,
                 .phases = scene->basin->phases,
                 .n = scene->basin->theta.count * scene->basin->velocity.count,
                 .stage = "phases"};
  kz_status status = kz_phases_label(&p, labelling->run);
  if (status == KZ_OK && store) status = write_group(scene->basin, &p, catalogue, store, summary);
  free(p.label);
  return kz_ranks_agree(labelling->run->ranks, status);
}

double kz_phases_bytes(const kz_basin_plan *plan) {
  return kz_phases_room(plan->phases, plan->theta.count * plan->velocity.count);
}
