/* Table of all that does not take every drive and every release, and the refusals by name (docs/reference/commands.md, Drives). */
#include <math.h>

#include "kapitza/study.h"
#include "stability/stability.h"
#include "sweep/sweep.h"
#include "kapitza/study_basin.h"
#include "kapitza/study_orbit.h"
#include "sweep/plan.h"

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
ASKS(no_basin, !s->has_basin)
ASKS(accuracy, s->has_basin && !isnan(s->basin->accuracy))
ASKS(orbit_on_ramp, s->has_orbit && s->parameters.has_ramp)
/* A sweep over a ramp: its values differ in their cells alone. */
static bool asks_more_than_cells(const kz_scene *s) {
  if (!is_swept(s, kz_sweep_is_of_release)) return false;
  bool of_cells = s->has_basin;
  for (int64_t i = 0; i < s->sweep->measure.count; i++) {
    const int64_t measure = s->sweep->measure.values[i];
    of_cells = of_cells && (measure == KZ_SWEEP_BASIN_FRACTIONS || measure == KZ_SWEEP_PHASES);
  }
  return !of_cells;
}

/* Request of a scene that does not take every drive or release, and the complaint. */
static const struct {
  bool (*is_asked)(const kz_scene *);
  kz_drive_need needs;
  const char *complaint;
} limits[] = {
    {asks_curves_of_sine, KZ_NEEDS_SINE,
     "stability.curves over k and subharmonics are those of the sine; leave them out, or ask for hill_1 to hill_5"},
    {asks_potential, KZ_NEEDS_SINE, "study potential needs a pivot that moves up and down as a sine; leave one of them out"},
    {asks_other_models, KZ_NEEDS_SINE, "orbit.model needs a pivot that moves up and down as a sine; choose the model pendulum"},
    {asks_rest, KZ_NEEDS_MIRROR,
     "study stability needs a pendulum that can rest, which this drive or torque always moves; leave one of them out"},
    {asks_table, KZ_NEEDS_MIRROR,
     "basin.method icm needs mirror symmetry, which this drive does not have; choose exact or direct"},
    {asks_tradeoff, KZ_NEEDS_MIRROR,
     "study tradeoff needs mirror symmetry, which this drive does not have; leave one of them out"},
    {asks_rk4, KZ_NEEDS_MIRROR,
     "numerics.scheme rk4 needs mirror symmetry, which this drive does not have; choose processed or split6"},
    {asks_more_than_cells, KZ_NEEDS_NO_RAMP_OVER,
     "a sweep over a ramp needs the study basin and measures basin_fractions and phases only"},
    {asks_no_basin, KZ_NEEDS_STROBE, "needs the study basin; add it to the scene"},
    {asks_table, KZ_NEEDS_STROBE, "basin.method icm follows whole drive periods from phase 0 only; choose exact or direct"},
    {asks_accuracy, KZ_NEEDS_STROBE, "basin.accuracy needs starts at phase 0 and no ramp; leave one of them out"},
    {asks_tradeoff, KZ_NEEDS_STROBE, "study tradeoff needs starts at phase 0 and no ramp; leave one of them out"},
    {asks_orbit_on_ramp, KZ_NEEDS_STROBE, "study orbit does not follow a ramp; leave one of them out"},
};

/* The complaint of the first row that the scene asks for; NULL = none. */
static const char *limit_of(const kz_scene *scene, kz_drive_need needs) {
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
    if (limits[i].needs == needs && limits[i].is_asked(scene)) return limits[i].complaint;
  for (int i = 0; i < kz_study_count; i++) {
    const char *limit =
        kz_studies[i]->limit && kz_study_is_wanted(kz_studies[i], scene) ? kz_studies[i]->limit(scene, needs) : NULL;
    if (limit) return limit;
  }
  return NULL;
}

/* Complaints about cells that are released at many phases. */
static const char *limit_of_phases(const kz_scene *scene) {
  const char *why = limit_of(scene, KZ_NEEDS_ONE_PHASE);
  return why ? why : limit_of(scene, KZ_NEEDS_STROBE);
}

/* The complaint about a ramp; NULL = none. */
static const char *wrong_ramp(const kz_parameters *parameters) {
  const kz_pendulum_keys *written = &parameters->written;
  if (written->ramp_key == KZ_RAMP_DAMPING && written->ramp_from < 0) return "from: is below 0; a damping must be at least 0";
  if (written->ramp_key == KZ_RAMP_DRIVE && !(fabs(parameters->pendulum.m) > 0))
    return "key: the drive has amplitude 0, so a ramp cannot change it in proportion; choose damping";
  return NULL;
}

/* The complaint about what contradicts basin.phases; NULL = none. */
static const char *wrong_phases(const kz_scene *scene) {
  if (!scene->has_basin || scene->basin->phases <= 0) return NULL;
  if (scene->basin->method != KZ_METHOD_EXACT) return "needs basin.method exact; choose that method";
  if (!(scene->parameters.pendulum.beta > 0))
    return "needs damping, because without it there are no attractors; leave it out, or give damping";
  return limit_of_phases(scene);
}

static kz_status check_release(const kz_scene *scene) {
  const char *phases = wrong_phases(scene);
  if (phases) return kz_fail(KZ_REFUSED, "basin.phases: %s", phases);
  const bool of_all = scene->has_sweep && scene->has_basin && kz_sweep_measures(scene->sweep, KZ_SWEEP_PHASES);
  const char *all = of_all ? limit_of_phases(scene) : NULL;
  if (all) return kz_fail(KZ_REFUSED, "sweep.measure: phases releases at other phases than 0; %s", all);
  const bool ramp = scene->parameters.has_ramp;
  const char *wrong = ramp ? wrong_ramp(&scene->parameters) : NULL;
  if (wrong) return kz_fail(KZ_REFUSED, "pendulum.ramp.%s", wrong);
  const char *why = limit_of(scene, KZ_NEEDS_NO_RAMP_OVER);
  if (!why && kz_release_strobes(&scene->parameters.release) > 0) why = limit_of(scene, KZ_NEEDS_STROBE);
  return why ? kz_fail(KZ_REFUSED, "%s: %s", ramp ? "pendulum.ramp" : "basin.start_phase", why) : KZ_OK;
}

/* The complaint about the numbers of a chart of stability; NULL = none. */
static const char *wrong_chart(const kz_scene *scene) {
  if (!scene->has_stability) return NULL;
  const kz_axis m = kz_stability_axes(scene->stability).m;
  if (scene->parameters.written.vertical.count > 0 && !(fabs(scene->parameters.pendulum.m) > 0))
    return "pendulum.m: is 0, but study stability counts pendulum.vertical in units of it; give another m";
  if (kz_stability_has_curve(scene->stability, "hill_") && fmax(fabs(m.min), fabs(m.max)) > KZ_HILL_MOST_M)
    return "stability.m.max|stability.q.max: is too far for the curves hill_1 to hill_5, which go to m = 1000; leave them out, "
           "or "
           "end before";
  return NULL;
}

kz_status kz_drive_check(const kz_scene *scene) {
  const kz_pendulum *p = &scene->parameters.pendulum;
  const char *chart = wrong_chart(scene);
  if (chart) return kz_fail(KZ_REFUSED, "%s", chart);
  const bool varied = is_swept(scene, kz_sweep_is_of_drive);
  const char *why = kz_is_sine(p) && !varied ? NULL : limit_of(scene, KZ_NEEDS_SINE);
  if (!why && (!kz_is_mirrored(p) || varied)) why = limit_of(scene, KZ_NEEDS_MIRROR);
  if (why) return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), why);
  return check_release(scene);
}

kz_status kz_drive_check_sine(const kz_scene *scene, const char *complaint) {
  if (kz_is_sine(&scene->parameters.pendulum) && !is_swept(scene, kz_sweep_is_of_drive)) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), complaint);
}
