/* The studies, one row each, in the order in which they run, and the groups of the result file. */
#include "basin/basin.h"
#include "kapitza/study.h"

#define ROW(name, check) {#name, offsetof(kz_scene, has_##name), kz_##name##_cost, kz_##name##_run, check},
const kz_study kz_studies[] = {KZ_STUDIES(ROW)};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];

#define GROUP(name, check) {#name, kz_##name##_variables},
/* clang-format off */
const kz_group kz_groups[] = {
    {"pendulum", kz_pendulum_variables},
    {"phases", kz_phases_variables},
    {"boundary", kz_boundary_variables},
    {"shocks", kz_shocks_variables},
    KZ_STUDIES(GROUP)
    {NULL, NULL},
};
/* clang-format on */

kz_status kz_studies_check(const kz_scene *scene) {
  KZ_TRY(kz_drive_check(scene));
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i].check && kz_study_is_wanted(&kz_studies[i], scene)) KZ_TRY(kz_studies[i].check(scene));
  return KZ_OK;
}
