/* What a scene can ask for, in the order in which it is modelled: one row per study. */
#include "accuracy/tradeoff.h"
#include "attractors/attractors.h"
#include "basin/basin.h"
#include "kapitza/study.h"
#include "orbit/orbit.h"
#include "potential/potential.h"
#include "stability/stability.h"
#include "sweep/sweep.h"

const kz_study kz_studies[] = {
    {"basin", kz_basin_wanted, kz_basin_cost, kz_basin_run},
    {"attractors", kz_attractors_wanted, kz_attractors_cost, kz_attractors_run},
    {"orbit", kz_orbit_wanted, kz_orbit_cost, kz_orbit_run},
    {"stability", kz_stability_wanted, kz_stability_cost, kz_stability_run},
    {"potential", kz_potential_wanted, kz_potential_cost, kz_potential_run},
    {"sweep", kz_sweep_wanted, kz_sweep_cost, kz_sweep_run},
    {"tradeoff", kz_tradeoff_wanted, kz_tradeoff_cost, kz_tradeoff_run},
};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];
