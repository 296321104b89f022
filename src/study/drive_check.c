/* Refuses, by name, studies and keys that need the drive k - m cos t if the scene has another drive. */
#include <math.h>

#include "kapitza/study.h"
#include "stability/stability.h"
#include "sweep/sweep.h"
#include "basin/plan.h"
#include "orbit/plan.h"
#include "sweep/plan.h"
#include "chart/plan.h"

static const char needs_pivot[] = "study chart needs a pivot that moves up and down as a sine; leave one of them out";

static bool is_centred(const kz_scene *scene) {
  return scene->has_basin && (scene->basin->theta.centre.text[0] || scene->basin->velocity.centre.text[0]);
}

/* The complaint about what contradicts a release at another phase or during a ramp; NULL = none. */
static const char *needs_no_release(const kz_scene *scene) {
  const kz_basin_plan *plan = scene->basin;
  if (!scene->has_basin) return "needs the study basin; add it to the scene";
  if (plan->method == KZ_METHOD_ICM)
    return "basin.method icm follows whole drive periods from phase 0 only; choose exact or direct";
  if (!isnan(plan->accuracy)) return "basin.accuracy needs starts at phase 0 and no ramp; leave one of them out";
  if (plan->proof) return "basin.proof needs starts at phase 0 and no ramp; leave one of them out";
  if (plan->has_boundary) return "basin.boundary needs starts at phase 0 and no ramp; leave one of them out";
  if (scene->has_tradeoff) return "study tradeoff needs starts at phase 0 and no ramp; leave one of them out";
  if (scene->has_orbit && scene->parameters.has_ramp) return "study orbit does not follow a ramp; leave one of them out";
  return NULL;
}

/* The complaint about a ramp; NULL = none. */
static const char *wrong_ramp(const kz_parameters *parameters) {
  const kz_pendulum_keys *written = &parameters->written;
  if (written->ramp_key == KZ_RAMP_DAMPING && written->ramp_from < 0) return "from: is below 0; a damping must be at least 0";
  if (written->ramp_key == KZ_RAMP_DAMPING && !isnan(written->torque_amplitude))
    return "key: a damping that changes also changes the swing from which torque_amplitude counts angles; leave one of them "
           "out";
  if (written->ramp_key == KZ_RAMP_DRIVE && !(fabs(parameters->pendulum.m) > 0))
    return "key: the drive has amplitude 0, so a ramp cannot change it in proportion; choose damping";
  return NULL;
}

/* Whether an axis of the scene's chart is of such a key. */
static bool is_charted(const kz_scene *scene, bool (*is_such)(int32_t parameter)) {
  return scene->has_chart && (is_such(scene->chart->x.parameter) || is_such(scene->chart->y.parameter));
}

/* A sweep over a ramp: its values differ in their cells alone. */
static const char *needs_cells(const kz_scene *scene) {
  if (is_charted(scene, kz_sweep_is_of_release))
    return "study chart does not follow a ramp; choose another parameter for the chart";
  if (!scene->has_sweep || !kz_sweep_is_of_release(scene->sweep->parameter)) return NULL;
  bool of_cells = scene->has_basin;
  for (int64_t i = 0; i < scene->sweep->measure.count; i++) {
    const int64_t measure = scene->sweep->measure.values[i];
    of_cells = of_cells && (measure == KZ_SWEEP_BASIN_FRACTIONS || measure == KZ_SWEEP_PHASES);
  }
  return of_cells ? NULL : "a sweep over a ramp needs the study basin and measures basin_fractions and phases only";
}

/* The first study or method that needs the sine; NULL = none. */
static const char *needs_sine(const kz_scene *scene) {
  if (scene->has_chart) return needs_pivot;
  if (scene->has_stability && !kz_is_sine(&scene->parameters.pendulum) && kz_stability_needs_sine(scene->stability))
    return "stability.curves over k and subharmonics are those of the sine; leave them out, or ask for hill_1 to hill_5";
  if (scene->has_potential) return "study potential needs a pivot that moves up and down as a sine; leave one of them out";
  if (scene->has_orbit && scene->orbit->model != KZ_PENDULUM)
    return "orbit.model needs a pivot that moves up and down as a sine; choose the model pendulum";
  if (scene->has_sweep &&
      (kz_sweep_measures(scene->sweep, KZ_SWEEP_FLUTTER_AMPLITUDE) || kz_sweep_measures(scene->sweep, KZ_SWEEP_FLUTTER_RANGE)))
    return "sweep.measure flutter_amplitude and flutter_zone need a pivot that moves up and down as a sine; leave one of them "
           "out";
  return NULL;
}

static const char *needs_mirror(const kz_scene *scene) {
  if (scene->has_stability && !kz_is_mirrored(&scene->parameters.pendulum))
    return "study stability needs a pendulum that can rest, which this drive or torque always moves; leave one of them out";
  if (scene->has_basin && scene->basin->method == KZ_METHOD_ICM)
    return "basin.method icm needs mirror symmetry, which this drive does not have; choose exact or direct";
  if (scene->has_tradeoff) return "study tradeoff needs mirror symmetry, which this drive does not have; leave one of them out";
  if (scene->asked.scheme == kz_scheme_find("rk4"))
    return "numerics.scheme rk4 needs mirror symmetry, which this drive does not have; choose processed or split6";
  return NULL;
}

/* The complaint about what contradicts the release of all cells at many phases; NULL = none. */
static const char *needs_phases(const kz_scene *scene) {
  if (scene->has_basin && scene->basin->undecided == KZ_UNDECIDED_DECIDE)
    return "basin.undecided decide needs starts at one phase; choose flag";
  if (is_centred(scene)) return "a window by centre and width needs starts at one phase; give min and max";
  return needs_no_release(scene);
}

/* The complaint about what contradicts the measure phases of a sweep; NULL = none. */
static const char *needs_all_phases(const kz_scene *scene) {
  const bool wanted = scene->has_sweep && kz_sweep_measures(scene->sweep, KZ_SWEEP_PHASES);
  return wanted && scene->has_basin ? needs_phases(scene) : NULL;
}

/* The complaint about what contradicts basin.phases; NULL = none. */
static const char *needs_one_phase(const kz_scene *scene) {
  if (!scene->has_basin || scene->basin->phases <= 0) return NULL;
  if (scene->basin->method != KZ_METHOD_EXACT) return "needs basin.method exact; choose that method";
  if (!(scene->parameters.pendulum.beta > 0))
    return "needs damping, because without it there are no attractors; leave it out, or give damping";
  return needs_phases(scene);
}

static kz_status check_release(const kz_scene *scene) {
  const char *phases = needs_one_phase(scene);
  if (phases) return kz_fail(KZ_REFUSED, "basin.phases: %s", phases);
  const char *all = needs_all_phases(scene);
  if (all) return kz_fail(KZ_REFUSED, "sweep.measure: phases releases at other phases than 0; %s", all);
  const bool ramp = scene->parameters.has_ramp;
  const char *wrong = ramp ? wrong_ramp(&scene->parameters) : NULL;
  if (wrong) return kz_fail(KZ_REFUSED, "pendulum.ramp.%s", wrong);
  const char *why = needs_cells(scene);
  if (!why && kz_release_strobes(&scene->parameters.release) > 0) why = needs_no_release(scene);
  return why ? kz_fail(KZ_REFUSED, "%s: %s", ramp ? "pendulum.ramp" : "basin.start_phase", why) : KZ_OK;
}

/* Whether a sweep or a chart gives the drive other forms than the scene's. */
static bool drive_is_varied(const kz_scene *scene) {
  return (scene->has_sweep && kz_sweep_is_of_drive(scene->sweep->parameter)) || is_charted(scene, kz_sweep_is_of_drive);
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
  const bool varied = drive_is_varied(scene);
  const char *why = kz_is_sine(p) && !varied ? NULL : needs_sine(scene);
  if (!why && (!kz_is_mirrored(p) || varied)) why = needs_mirror(scene);
  if (why) return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), why);
  return check_release(scene);
}

kz_status kz_drive_check_chart(const kz_scene *scene) {
  if (kz_is_sine(&scene->parameters.pendulum) && !drive_is_varied(scene)) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: %s", kz_drive_made_by(&scene->parameters.written), needs_pivot);
}
