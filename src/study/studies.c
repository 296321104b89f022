/* The studies, one row each, in the order in which they run. */
#include "accuracy/tradeoff.h"
#include "attractors/attractors.h"
#include "basin/basin.h"
#include "chart/chart.h"
#include "edge/edge.h"
#include "kapitza/study.h"
#include "manifolds/manifolds.h"
#include "orbit/orbit.h"
#include "potential/potential.h"
#include "saddles/saddles.h"
#include "stability/stability.h"
#include "sweep/sweep.h"

const kz_study kz_studies[] = {
    {"basin", kz_basin_wanted, kz_basin_cost, kz_basin_run, kz_basin_check, kz_basin_measure},
    {"attractors", kz_attractors_wanted, kz_attractors_cost, kz_attractors_run, kz_attractors_check, kz_attractors_measure},
    {"saddles", kz_saddles_wanted, kz_saddles_cost, kz_saddles_run, NULL, kz_saddles_measure},
    {"manifolds", kz_manifolds_wanted, kz_manifolds_cost, kz_manifolds_run, NULL, kz_manifolds_measure},
    {"edge", kz_edge_wanted, kz_edge_cost, kz_edge_run, NULL, kz_edge_measure},
    {"orbit", kz_orbit_wanted, kz_orbit_cost, kz_orbit_run, kz_orbit_check, kz_orbit_measure},
    {"stability", kz_stability_wanted, kz_stability_cost, kz_stability_run, NULL, kz_stability_measure},
    {"potential", kz_potential_wanted, kz_potential_cost, kz_potential_run, NULL, kz_potential_measure},
    {"sweep", kz_sweep_wanted, kz_sweep_cost, kz_sweep_run, kz_sweep_check, kz_sweep_measure},
    {"chart", kz_chart_wanted, kz_chart_cost, kz_chart_run, NULL, kz_chart_measure},
    {"tradeoff", kz_tradeoff_wanted, kz_tradeoff_cost, kz_tradeoff_run, kz_tradeoff_check, kz_tradeoff_measure},
};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];

kz_status kz_studies_check(const kz_scene *scene) {
  KZ_TRY(kz_drive_check(scene));
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i].check && kz_studies[i].wanted(scene)) KZ_TRY(kz_studies[i].check(scene));
  return KZ_OK;
}
