/* The file's group /phases: the share of a window that ends alike whatever the phase of release. */
#include "numerics/resolve.h"
#include "phases.h"
#include "release.h"

/* The id in the file; -1 = none. */
static int32_t id_at(const kz_catalogue *catalogue, int16_t number) {
  return number > 0 ? catalogue->id_of[number] : -1;
}

static double share_of(const kz_phases *p, const kz_catalogue *catalogue, int64_t phase, int64_t id) {
  int64_t count = 0;
  for (int64_t cell = 0; cell < p->n; cell++) count += id_at(catalogue, kz_phases_at(p, phase, cell)) == id;
  return (double)count / (double)p->n;
}

static kz_status write_group(const kz_basin_plan *plan, const kz_phases *p, const kz_catalogue *catalogue,
                             kz_store *store, FILE *summary) {
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

/* Releases the cells at the number of phases that the key basin.phases gives, and writes group /phases: the share of
 * the window whose starts end on the same attractor at all of them. A function of kz_basin_part. */
static kz_status find_phases(void *own, const kz_chunks *chunks, kz_store *store, FILE *summary) {
  const kz_scene *scene = own;
  const kz_basin_plan *plan = scene->basin;
  const kz_run *run = chunks->labelling->run;
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  const kz_release release = kz_release_of(scene, pendulum);
  if (scene->release->phases <= 0) return KZ_OK;
  kz_phases p = {.labeller = kz_cell_labeller(plan, chunks->labelling->dynamics),
                 .release = release,
                 .phases = scene->release->phases,
                 .n = plan->theta.count * plan->velocity.count,
                 .folded = kz_window_mirrors_itself(plan) && kz_phases_fold(pendulum, &release, scene->release->phases),
                 .stage = "phases"};
  kz_status status = kz_phases_label(&p, run);
  if (status == KZ_OK && store) status = write_group(plan, &p, chunks->catalogue, store, summary);
  kz_phases_free(&p);
  return kz_ranks_agree(run->ranks, status);
}

static double phases_bytes(const kz_scene *scene) {
  return kz_phases_bytes(scene->release->phases, scene->basin->theta.count * scene->basin->velocity.count);
}

const kz_basin_part kz_release_part = {.bytes = phases_bytes, .find = find_phases};
