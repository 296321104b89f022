/* Motions of the three models through one interface. */
#include "numerics/resolve.h"
#include "orbit.h"

/* Periods of a simpler model that are skipped at once. */
enum { CHUNK = 1024 };

void kz_model_make(const kz_scene *scene, kz_model *model) {
  const kz_orbit_plan *orbit = scene->orbit;
  const kz_pendulum *p = &scene->parameters.pendulum;
  bool inverted = orbit->model == KZ_MATHIEU && orbit->about == KZ_ABOUT_INVERTED;
  *model = (kz_model){.kind = orbit->model, .pendulum = *p, .samples = kz_orbit_samples(scene)};
  if (inverted) model->pendulum = (kz_pendulum){-p->k, p->beta, -p->m};
  if (inverted) model->origin = M_PI;
  if (model->kind != KZ_PENDULUM) return;
  model->numerics = kz_orbit_numerics(scene);
  model->flow = kz_flow_create(p, &model->numerics);
}

void kz_model_free(kz_model *model) {
  kz_flow_free(model->flow);
  model->flow = NULL;
}

/* Up to CHUNK periods of a simpler model. */
static void skip_chunk(const kz_model *model, int64_t periods, kz_state *state) {
  double theta[CHUNK + 1], velocity[CHUNK + 1];
  const double start[] = {state->theta - model->origin, state->velocity};
  kz_sample_model(model->kind, &model->pendulum, periods, 1, start, theta, velocity);
  *state = (kz_state){theta[periods] + model->origin, velocity[periods]};
}

void kz_model_skip(const kz_model *model, int64_t periods, kz_state *state) {
  int64_t turns = 0;
  if (model->flow) kz_advance(model->flow, 1, periods, &state->theta, &state->velocity, &turns);
  for (int64_t done = 0; !model->flow && done < periods; done += CHUNK)
    skip_chunk(model, periods - done < CHUNK ? periods - done : CHUNK, state);
}

static kz_status check_range(const kz_orbit_motion *motion) {
  for (int64_t i = 0; i <= motion->periods * motion->samples; i++) {
    if (isfinite(motion->theta[i]) && isfinite(motion->velocity[i])) continue;
    return kz_fail(
        KZ_REFUSED,
        "orbit: the motion becomes too large for double precision in period %lld; use fewer periods or a smaller start",
        (long long)(i / motion->samples));
  }
  return KZ_OK;
}

kz_status kz_model_record(const kz_model *model, int64_t periods, kz_state start, kz_orbit_motion *motion) {
  size_t n = (size_t)(periods * model->samples) + 1;
  *motion = (kz_orbit_motion){periods, model->samples, kz_malloc(n * sizeof(double)), kz_malloc(n * sizeof(double))};
  if (model->flow) {
    kz_sample(model->flow, periods, model->samples, start.theta, start.velocity, motion->theta, motion->velocity);
  } else {
    const double from[] = {start.theta - model->origin, start.velocity};
    kz_sample_model(model->kind, &model->pendulum, periods, model->samples, from, motion->theta, motion->velocity);
    for (size_t i = 0; i < n; i++) motion->theta[i] += model->origin;
  }
  return check_range(motion);
}
