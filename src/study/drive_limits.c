/* Table of all that does not take every drive, and the refusals by name (docs/reference/commands.md, Drives). */
#include "stability/stability.h"
#include "sweep/sweep.h"
#include "kapitza/study_basin.h"
#include "kapitza/study_orbit.h"

/* Whether a key of the scene's sweep is such a one. */
static bool is_swept(const kz_scene *scene, bool (*is_such)(int32_t parameter)) {
  const kz_sweep_plan *plan = scene->sweep;
  if (!scene->has_sweep) return false;
  return kz_sweep_is_plane(plan) ? is_such(plan->x.parameter) || is_such(plan->y.parameter) : is_such(plan->parameter);
}

/* Whether a scene asks for something. */
#define ASKS(name, what)                       \
  static bool asks_##name(const kz_scene *s) { \
    return what;                               \
  }
ASKS(curves_of_sine, s->has_stability && !kz_is_sine(&s->parameters.pendulum) && kz_stability_needs_sine(s->stability))
ASKS(potential, s->has_potential)
ASKS(other_models, s->has_orbit && s->orbit->model != KZ_PENDULUM)
ASKS(rest, s->has_stability && !kz_is_mirrored(&s->parameters.pendulum))
ASKS(table, s->has_basin && s->basin->method == KZ_METHOD_ICM)
ASKS(tradeoff, s->has_tradeoff)
ASKS(rk4, s->asked.scheme == kz_scheme_find("rk4"))
/* Request of a scene that does not take every drive, and the complaint. */
static const struct {
  bool (*is_asked)(const kz_scene *);
  kz_drive_need needs;
  const char *complaint;
} limits[] = {
    {asks_curves_of_sine, KZ_NEEDS_SINE,
     "stability.curves over k and subharmonics are those of the sine; leave them out, or ask for hill_1 to hill_5"},
    {asks_potential, KZ_NEEDS_SINE,
     "study potential needs a pivot that moves up and down as a sine; leave one of them out"},
    {asks_other_models, KZ_NEEDS_SINE,
     "orbit.model needs a pivot that moves up and down as a sine; choose the model pendulum"},
    {asks_rest, KZ_NEEDS_MIRROR,
     "study stability needs a pendulum that can rest, which this drive or torque always moves; leave one of them out"},
    {asks_table, KZ_NEEDS_MIRROR,
     "basin.method icm needs mirror symmetry, which this drive does not have; choose exact or direct"},
    {asks_tradeoff, KZ_NEEDS_MIRROR,
     "study tradeoff needs mirror symmetry, which this drive does not have; leave one of them out"},
    {asks_rk4, KZ_NEEDS_MIRROR,
     "numerics.scheme rk4 needs mirror symmetry, which this drive does not have; choose processed or split6"},
};

/* The complaint of the first row that the scene asks for; NULL = none. */
const char *kz_drive_limit(const kz_scene *scene, kz_drive_need need) {
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
    if (limits[i].needs == need && limits[i].is_asked(scene)) return limits[i].complaint;
  for (int i = 0; i < kz_study_count; i++) {
    const char *limit =
        kz_studies[i]->limit && kz_study_is_wanted(kz_studies[i], scene) ? kz_studies[i]->limit(scene, need) : NULL;
    if (limit) return limit;
  }
  return NULL;
}

/* The complaint about the numbers of a chart of stability; NULL = none. */
static const char *wrong_chart(const kz_scene *scene) {
  if (!scene->has_stability) return NULL;
  const kz_axis m = kz_stability_axes(scene->stability).m;
  if (scene->parameters.written.vertical.count > 0 && !(fabs(scene->parameters.pendulum.m) > 0))
    return "pendulum.m: is 0, but study stability counts pendulum.vertical in units of it; give another m";
  if (kz_stability_has_curve(scene->stability, "hill_") && fmax(fabs(m.min), fabs(m.max)) > KZ_HILL_MOST_M)
    return "stability.m.max|stability.q.max: is too far for the curves hill_1 to hill_5, which go to m = 1000; leave "
           "them out, "
           "or "
           "end before";
  return NULL;
}

kz_status kz_drive_check(const kz_scene *scene) {
  const kz_pendulum *p = &scene->parameters.pendulum;
  const char *chart = wrong_chart(scene);
  if (chart) return kz_fail(KZ_REFUSED, "%s", chart);
  const bool varied = is_swept(scene, kz_sweep_is_of_drive);
  const char *why = kz_is_sine(p) && !varied ? NULL : kz_drive_limit(scene, KZ_NEEDS_SINE);
  if (!why && (!kz_is_mirrored(p) || varied)) why = kz_drive_limit(scene, KZ_NEEDS_MIRROR);
  if (why) return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), why);
  return KZ_OK;
}

kz_status kz_drive_check_sine(const kz_scene *scene, const char *complaint) {
  if (kz_is_sine(&scene->parameters.pendulum) && !is_swept(scene, kz_sweep_is_of_drive)) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), complaint);
}
