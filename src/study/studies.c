/* The studies, one row each, in the order in which they run, and the groups of the result file. */
#include "accuracy/accuracy.h"
#include "basin/basin.h"
#include "kapitza/study.h"
#include "orbit/orbit.h"
#include "sweep/sweep.h"

/* `check`: NULL = nothing to check. */
#define STUDY(name, check) \
  {#name, offsetof(kz_scene, has_##name), kz_##name##_cost, kz_##name##_run, check, kz_##name##_measure}

const kz_study kz_studies[] = {
    STUDY(basin, kz_basin_check),
    STUDY(attractors, kz_attractors_check),
    STUDY(saddles, NULL),
    STUDY(manifolds, NULL),
    STUDY(edge, NULL),
    STUDY(orbit, kz_orbit_check),
    STUDY(stability, NULL),
    STUDY(potential, NULL),
    STUDY(sweep, kz_sweep_check),
    STUDY(chart, NULL),
    STUDY(tradeoff, kz_tradeoff_check),
};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];

const kz_group kz_groups[] = {
    {"pendulum", kz_pendulum_variables},   {"attractors", kz_attractors_variables},
    {"basin", kz_basin_variables},         {"phases", kz_phases_variables},
    {"boundary", kz_boundary_variables},   {"shocks", kz_shocks_variables},
    {"saddles", kz_saddles_variables},     {"manifolds", kz_manifolds_variables},
    {"edge", kz_edge_variables},           {"orbit", kz_orbit_variables},
    {"stability", kz_stability_variables}, {"potential", kz_potential_variables},
    {"sweep", kz_sweep_variables},         {"chart", kz_chart_variables},
    {"tradeoff", kz_tradeoff_variables},   {NULL, NULL},
};

kz_status kz_studies_check(const kz_scene *scene) {
  KZ_TRY(kz_drive_check(scene));
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i].check && kz_study_is_wanted(&kz_studies[i], scene)) KZ_TRY(kz_studies[i].check(scene));
  return KZ_OK;
}
