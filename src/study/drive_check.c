/* What a study cannot ask of a pendulum whose drive is more than k - m cos t: refused by name. */
#include <math.h>
#include <stdio.h>

#include "kapitza/study.h"
#include "sweep/sweep.h"

/* The keys that make the drive what it is, as a message begins. */
static const char *keys_of(const kz_scene *scene) {
  const kz_pendulum_keys *written = &scene->parameters.written;
  if (!isnan(written->tilt)) return "pendulum.tilt";
  if (!isnan(written->ellipse)) return "pendulum.ellipse";
  if (!isnan(written->torque)) return "pendulum.torque";
  if (written->harmonics.count > 0) return "pendulum.harmonics";
  if (written->waveform > KZ_SINE) return "pendulum.waveform";
  return "basin.start_phase";
}

/* The first study or method that needs the sine; NULL = none. */
static const char *needs_sine(const kz_scene *scene) {
  if (scene->has_chart) return "study chart follows pendulums whose pivot moves up and down as a sine";
  if (scene->has_potential) return "study potential has a closed formula for the sine alone";
  if (scene->has_orbit && scene->orbit.model != KZ_PENDULUM) return "orbit.model has equations for the sine alone";
  if (scene->has_basin && (scene->basin.theta.centre.text[0] || scene->basin.velocity.centre.text[0]))
    return "windows by centre and width have their reference orbit for the sine alone; give min and max";
  if (scene->has_basin && scene->basin.undecided == KZ_UNDECIDED_DECIDE)
    return "basin.undecided decide has orbits of any precision for the sine alone; choose flag";
  if (scene->has_basin && scene->basin.proof) return "basin.proof has bounds for the sine alone";
  if (scene->has_sweep && (kz_sweep_measures(&scene->sweep, KZ_SWEEP_FLUTTER_AMPLITUDE) ||
                           kz_sweep_measures(&scene->sweep, KZ_SWEEP_FLUTTER_RANGE)))
    return "sweep.measure flutter_amplitude and flutter_zone have their theory for the sine alone";
  return NULL;
}

static const char *needs_mirror(const kz_scene *scene) {
  if (scene->has_basin && scene->basin.method == KZ_METHOD_ICM)
    return "basin.method icm stores half of the plane, which is the mirror image of the other; choose direct or exact";
  if (scene->has_tradeoff) return "study tradeoff has settings of method icm, which need mirror symmetry";
  if (scene->asked.scheme == kz_scheme_find("rk4")) return "numerics.scheme rk4 has kicks without a phase; choose split6";
  return NULL;
}

kz_status kz_drive_check(const kz_scene *scene) {
  const kz_pendulum *p = &scene->parameters.pendulum;
  const char *why = kz_is_sine(p) ? NULL : needs_sine(scene);
  if (!why && !kz_is_mirrored(p)) why = needs_mirror(scene);
  return why ? kz_fail(KZ_REFUSED, "%s: %s", keys_of(scene), why) : KZ_OK;
}
