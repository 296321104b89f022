/* Limits of releases: the table of studies and keys that refuse one, by name. */
#include "kapitza/study_orbit.h"
#include "release.h"

/* Whether a scene asks for something. */
#define ASKS(name, what)                       \
  static bool asks_##name(const kz_scene *s) { \
    return what;                               \
  }
ASKS(no_basin, !s->has_basin)
ASKS(table, s->has_basin && s->basin->method == KZ_METHOD_ICM)
ASKS(accuracy, s->has_basin && !isnan(s->basin->accuracy))
ASKS(tradeoff, s->has_tradeoff)
ASKS(orbit_on_ramp, s->has_orbit && s->has_ramp)

/* Keys that need starts at a strobe of the final drive, with the complaint. */
static const struct {
  bool (*is_asked)(const kz_scene *);
  const char *complaint;
} limits[] = {
    {asks_no_basin, "needs the study basin; add it to the scene"},
    {asks_table, "basin.method icm follows whole drive periods from phase 0 only; choose exact or direct"},
    {asks_accuracy, "basin.accuracy needs starts at phase 0 and no ramp; leave one of them out"},
    {asks_tradeoff, "study tradeoff needs starts at phase 0 and no ramp; leave one of them out"},
    {asks_orbit_on_ramp, "study orbit does not follow a ramp; leave one of them out"},
};

/* The complaint about a release before the drive has its final form; NULL = none. */
static const char *limit_of_release(const kz_scene *scene) {
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
    if (limits[i].is_asked(scene)) return limits[i].complaint;
  return kz_drive_limit(scene, KZ_NEEDS_STROBE);
}

/* Returns the complaint of cells released at many phases. */
static const char *limit_of_phases(const kz_scene *scene) {
  const char *why = kz_drive_limit(scene, KZ_NEEDS_ONE_PHASE);
  return why ? why : limit_of_release(scene);
}

/* The complaint about what contradicts basin.phases; NULL = none. */
static const char *wrong_phases(const kz_scene *scene) {
  if (scene->release->phases <= 0) return NULL;
  if (scene->basin->method != KZ_METHOD_EXACT) return "needs basin.method exact; choose that method";
  if (!(scene->parameters.pendulum.beta > 0))
    return "needs damping, because without it there are no attractors; leave it out, or give damping";
  return limit_of_phases(scene);
}

kz_status kz_release_check(const kz_scene *scene) {
  const char *phases = wrong_phases(scene);
  if (phases) return kz_fail(KZ_REFUSED, "basin.phases: %s", phases);
  const kz_release release = kz_release_of(scene, &scene->parameters.pendulum);
  const char *why = kz_release_strobes(&release) > 0 && !scene->has_ramp ? limit_of_release(scene) : NULL;
  return why ? kz_fail(KZ_REFUSED, "basin.start_phase: %s", why) : KZ_OK;
}

kz_status kz_alike_check(const kz_scene *scene) {
  const bool is_named = kz_sweep_part_words(scene->sweep, &kz_alike_part, true).count > 0;
  const char *why = is_named && scene->has_basin ? limit_of_phases(scene) : NULL;
  return why ? kz_fail(KZ_REFUSED, "sweep.measure: phases releases at other phases than 0; %s", why) : KZ_OK;
}

/* A sweep over a ramp: its values differ in their cells alone. */
static bool asks_more_than_cells(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  if (!scene->has_sweep) return false;
  const bool is_plane = kz_sweep_is_plane(plan);
  if (!kz_sweep_parameter_at(is_plane ? plan->x.parameter : plan->parameter)->plan &&
      !(is_plane && kz_sweep_parameter_at(plan->y.parameter)->plan))
    return false;
  const int64_t of_cells =
      kz_sweep_part_words(plan, &kz_alike_part, true).count + kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS);
  return !scene->has_basin || of_cells < plan->measure.count;
}

/* The complaint about a ramp; NULL = none. */
static const char *wrong_ramp(const kz_scene *scene) {
  const kz_ramp_plan *ramp = scene->ramp;
  if (ramp->key == KZ_RAMP_DAMPING && ramp->from < 0) return "from: is below 0; a damping must be at least 0";
  if (ramp->key == KZ_RAMP_DRIVE && !(fabs(scene->parameters.pendulum.m) > 0))
    return "key: the drive has amplitude 0, so a ramp cannot change it in proportion; choose damping";
  return NULL;
}

kz_status kz_ramp_check(const kz_scene *scene) {
  const char *wrong = wrong_ramp(scene);
  if (wrong) return kz_fail(KZ_REFUSED, "pendulum.ramp.%s", wrong);
  const kz_release release = kz_release_of(scene, &scene->parameters.pendulum);
  const char *why = asks_more_than_cells(scene)
                        ? "a sweep over a ramp needs the study basin and measures basin_fractions and phases only"
                    : kz_release_strobes(&release) > 0 ? limit_of_release(scene)
                                                       : NULL;
  return why ? kz_fail(KZ_REFUSED, "pendulum.ramp: %s", why) : KZ_OK;
}
