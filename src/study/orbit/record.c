/* A motion by itself, without what the study tells of it. */

#include "kapitza/study_live.h"
#include "motion.h"

/* Keeps every so many samples. */
static void thin(kz_motion *motion, int64_t stride) {
  for (int64_t i = 0; i <= motion->periods * motion->samples / stride; i++) {
    motion->theta[i] = motion->theta[i * stride];
    motion->velocity[i] = motion->velocity[i * stride];
  }
}

kz_status kz_orbit_record(const kz_scene *scene, int64_t *samples, double **theta, double **velocity) {
  const kz_orbit_plan *plan = &scene->orbit;
  kz_state state = {plan->theta, plan->velocity};
  kz_motion motion = {0};
  kz_model model;
  kz_model_make(scene, &model);
  if (plan->transient > 0) kz_model_skip(&model, plan->transient, &state);
  const kz_status status = kz_model_record(&model, plan->periods, state, &motion);
  if (status == KZ_OK) thin(&motion, motion.samples / plan->samples_per_period);
  kz_model_free(&model);
  *samples = plan->periods * plan->samples_per_period + 1;
  *theta = motion.theta;
  *velocity = motion.velocity;
  return status;
}
