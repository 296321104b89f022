#include "scene_search.h"

#include "attractors/plan.h"
#include "numerics/cells.h"

kz_search kz_search_of_basin(const kz_basin_plan *plan) {
  return (kz_search){.window = kz_window_of(&plan->theta, &plan->velocity),
                     .starts = plan->starts,
                     .seed = plan->seed,
                     .max_periods = plan->max_periods,
                     .cells = plan->theta.count * plan->velocity.count,
                     .table_theta = plan->method == KZ_METHOD_ICM ? plan->table_theta : 0,
                     .table_velocity = plan->table_velocity};
}

kz_search kz_search_of_attractors(const kz_attractors_plan *plan, int64_t max_periods) {
  return (kz_search){.window = kz_window_of(&plan->theta, &plan->velocity),
                     .starts = plan->starts,
                     .seed = plan->seed,
                     .max_periods = max_periods};
}

kz_search kz_search_of(const kz_scene *scene) {
  if (!scene->has_basin)
    return kz_search_of_attractors(scene->attractors, kz_settling_periods(scene->parameters.pendulum.beta));
  kz_search search = kz_search_of_basin(scene->basin);
  search.table_theta = 0;
  return search;
}

kz_dynamics *kz_search_dynamics(const kz_scene *scene) {
  return kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics,
                            scene->has_basin ? scene->basin->max_period : scene->attractors->max_period);
}
