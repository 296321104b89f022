/* Records of motions on request. */
#include "kapitza/study_live.h"
#include "orbit/orbit.h"

/* Steps between two pauses: some 0.1 s. */
enum { PAUSE_STEPS = 1 << 20 };

static void free_motion(kz_orbit_motion *motion) {
  free(motion->theta);
  free(motion->velocity);
}

/* Records periods first .. first + n - 1 from `state`, angle within a turn, `turns` before it; advances both. */
static kz_status record_stretch(const kz_model *model, int64_t first, int64_t n, int64_t stride, kz_state *state,
                                double *turns, double *theta, double *velocity) {
  KZ_AUTOFREE_BY(free_motion) kz_orbit_motion motion = {0};
  const int64_t samples = model->samples / stride, last = n * model->samples;
  KZ_TRY(kz_model_record(model, n, *state, &motion));
  for (int64_t i = 0; i <= n * samples; i++) {
    theta[first * samples + i] = motion.theta[i * stride] + 2 * M_PI * *turns;
    velocity[first * samples + i] = motion.velocity[i * stride];
  }
  const double more = rint(motion.theta[last] / (2 * M_PI));
  *state = (kz_state){motion.theta[last] - 2 * M_PI * more, motion.velocity[last]};
  *turns += more;
  return KZ_OK;
}

kz_status kz_orbit_record(const kz_scene *scene, kz_status (*pause)(void *context), void *context, double *theta,
                          double *velocity) {
  const kz_orbit_plan *plan = scene->orbit;
  kz_state state = {plan->theta, plan->velocity};
  double turns = 0;
  KZ_AUTOFREE_BY(kz_model_free) kz_model model;
  kz_model_make(scene, &model);
  const int64_t fit = PAUSE_STEPS / model.numerics.steps_per_period, most = kz_larger(fit, 1);
  for (int64_t done = 0; done < plan->transient; done += most) {
    KZ_TRY(pause(context));
    kz_model_skip(&model, plan->transient - done < most ? plan->transient - done : most, &state);
  }
  for (int64_t done = 0; done < plan->periods; done += most) {
    const int64_t n = plan->periods - done < most ? plan->periods - done : most;
    KZ_TRY(pause(context));
    KZ_TRY(record_stretch(&model, done, n, model.samples / plan->samples_per_period, &state, &turns, theta, velocity));
  }
  return KZ_OK;
}
