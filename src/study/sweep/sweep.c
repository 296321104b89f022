/* Study `sweep`: quantities along one key of the pendulum mapping. */
#include "sweep.h"
#include "kapitza/study_basin.h"

/* Cost of measures of single points. */
static kz_cost points_cost(const kz_scene *scene) {
  kz_cost cost = {0};
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(scene->sweep, false, &i)); i++) {
    const kz_cost of_points = part->cost(scene);
    cost.cells += of_points.cells;
    cost.disk_bytes += of_points.disk_bytes;
    cost.memory_bytes += of_points.memory_bytes;
    cost.rank0_bytes += of_points.rank0_bytes;
  }
  return cost;
}

kz_cost kz_sweep_cost(const kz_scene *scene) {
  if (kz_sweep_is_plane(scene->sweep)) return points_cost(scene);
  const kz_cost of_points = points_cost(scene);
  const double values = (double)scene->sweep->values.count;
  const bool grid = kz_sweep_has_grid(scene);
  double times = 1;
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(scene->sweep, true, &i)); i++)
    times += part->times ? (double)part->times(scene) : 0;
  const double nodes = grid ? (double)scene->basin->table_theta * (double)scene->basin->table_velocity : 0;
  const double cells = grid ? (double)scene->basin->theta.count * (double)scene->basin->velocity.count : 0;
  return (kz_cost){.cells = (int64_t)(cells * values * times) + of_points.cells,
                   .disk_bytes = values * (sizeof(kz_sweep_catalogue) + 1e3) + of_points.disk_bytes,
                   .memory_bytes = 3 * values * sizeof(kz_sweep_catalogue) + 100 * nodes +
                                   (times > 1 ? 24 : 2) * cells + of_points.memory_bytes,
                   .rank0_bytes = of_points.rank0_bytes};
}

static bool has_branches(const kz_sweep_plan *plan) {
  bool wanted = kz_sweep_part_next(plan, true, &(int){0});
  for (int64_t measure = 0; measure < KZ_SWEEP_RELEASE_ANGLE; measure++)
    wanted = wanted || kz_sweep_measures(plan, measure);
  return wanted;
}

/* The catalogues and what joins them. */
static kz_status run_branches(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = scene->sweep;
  if (!has_branches(plan)) return KZ_OK;
  KZ_AUTOFREE_BY(kz_sweep_branches_free) kz_sweep_branches branches = {0};
  KZ_AUTOFREE kz_sweep_catalogue *catalogue = kz_malloc((size_t)plan->values.count * sizeof *catalogue);
  KZ_TRY(kz_sweep_catalogues(scene, run, catalogue));
  KZ_TRY(kz_sweep_branches_make(scene, run, catalogue, &branches));
  return kz_ranks_agree(run->ranks,
                        store ? kz_sweep_branches_write(scene, catalogue, &branches, store, summary) : KZ_OK);
}

/* One axis with its scale, its key and that key's unit. */
static kz_status write_axis(const char *name, const kz_plane_axis *axis, kz_store *store) {
  KZ_TRY(kz_axis_describe(&axis->values, axis->parameter, name, "plane", store));
  KZ_SCALE(store, "plane", name, axis->values.count, kz_axis_value(&axis->values, i));
  return KZ_OK;
}

kz_status kz_sweep_write_axes(const kz_sweep_plan *plan, kz_store *store) {
  KZ_TRY(write_axis("y", &plan->y, store));
  return write_axis("x", &plan->x, store);
}

static kz_status write_values(const kz_scene *scene, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = scene->sweep;
  if (kz_sweep_is_plane(plan)) {
    if (kz_sweep_has_points(plan)) kz_sweep_warn_steps(scene, summary);
    return kz_sweep_write_axes(plan, store);
  }
  KZ_TRY(kz_axis_describe(&plan->values, plan->parameter, "", "sweep", store));
  KZ_SCALE(store, "sweep", "value", plan->values.count, kz_sweep_value(plan, i));
  const char *unit = kz_axis_unit(&plan->values, plan->parameter);
  fprintf(summary, "sweep of %s%s%s, %lld values from %.10g to %.10g\n", kz_sweep_parameter_at(plan->parameter)->name,
          unit[0] ? " in " : "", unit, (long long)plan->values.count, kz_axis_written(&plan->values, plan->values.min),
          kz_axis_written(&plan->values, plan->values.max));
  kz_sweep_warn_steps(scene, summary);
  return KZ_OK;
}

kz_status kz_sweep_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  typedef kz_status (*run_fn)(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
#define RUN(code, word, run) run,
  static const run_fn runs[] = {KZ_SWEEP_MEASURES(RUN)};
  KZ_TRY(kz_ranks_agree(run->ranks, store ? write_values(scene, store, summary) : KZ_OK));
  KZ_TRY(run_branches(scene, run, store, summary));
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(scene->sweep, false, &i)); i++)
    KZ_TRY(part->run(scene, run, store, summary));
  for (int64_t i = 0; i < (int64_t)(sizeof runs / sizeof runs[0]); i++)
    if (runs[i] && kz_sweep_measures(scene->sweep, i)) KZ_TRY(runs[i](scene, run, store, summary));
  return KZ_OK;
}
