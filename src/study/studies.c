/* What a scene can ask for, in the order in which it is modelled: one row per study. */
#include "basin.h"
#include "kapitza/study.h"

const kz_study kz_studies[] = {
  {"basin", kz_basin_wanted, kz_basin_cost, kz_basin_run},
};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];
