/* The studies, one row each, in the order in which they run, and the groups of the result file. */
#include "basin/basin.h"
#include "sweep/sweep.h"

#define ROW(name) &kz_##name##_study,
const kz_study *const kz_studies[] = {KZ_STUDIES(ROW)};
const int kz_study_count = sizeof kz_studies / sizeof kz_studies[0];

#define GROUP(name) {#name, kz_##name##_variables},
/* clang-format off */
const kz_group kz_groups[] = {
    {"pendulum", kz_pendulum_variables},
    {"plane", kz_plane_variables},
    KZ_STUDIES(GROUP)
    {NULL, NULL},
};
/* clang-format on */

kz_status kz_studies_check(const kz_scene *scene) {
  KZ_TRY(kz_drive_check(scene));
  for (int pass = 0; pass < 2; pass++) /* parts come before what they are of */
    for (int i = 0; i < kz_study_count; i++)
      if ((pass == 0) == kz_study_is_part(kz_studies[i]) && kz_studies[i]->check &&
          kz_study_is_wanted(kz_studies[i], scene))
        KZ_TRY(kz_studies[i]->check(scene));
  return KZ_OK;
}

void kz_studies_begin(const kz_scene *scene, const kz_pendulum *pendulum, const double *swept, kz_dynamics *dynamics) {
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i]->begin && kz_study_is_wanted(kz_studies[i], scene))
      kz_studies[i]->begin(scene, pendulum, swept, dynamics);
}

kz_status kz_studies_describe(const kz_scene *scene, kz_store *store) {
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i]->describe && kz_study_is_wanted(kz_studies[i], scene))
      KZ_TRY(kz_studies[i]->describe(scene, store));
  return KZ_OK;
}

static void **plan_of(const kz_study *study, kz_scene *scene) {
  return (void **)((char *)scene + study->plan);
}

void kz_plans_create(kz_scene *scene) {
  for (int i = 0; i < kz_study_count; i++) *plan_of(kz_studies[i], scene) = kz_calloc(1, kz_studies[i]->plan_bytes);
}

void kz_plans_copy(kz_scene *scene) {
  for (int i = 0; i < kz_study_count; i++) {
    void **plan = plan_of(kz_studies[i], scene);
    *plan = memcpy(kz_malloc(kz_studies[i]->plan_bytes), *plan, kz_studies[i]->plan_bytes);
  }
}

void kz_plans_free(kz_scene *scene) {
  for (int i = 0; i < kz_study_count; i++) free(*plan_of(kz_studies[i], scene));
}
