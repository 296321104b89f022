/* The values of sweeps and charts: which keys they are of, and the pendulum at each. */
#include <math.h>
#include <string.h>

#include "kapitza/study.h"

#define KEY(name_, unit_) {#name_, unit_, offsetof(kz_pendulum_keys, name_)}
const kz_sweep_parameter kz_sweep_parameters[KZ_SWEEP_PARAMETERS] = {
    KEY(quality_factor, "1"),
    KEY(drive_frequency, "1"),
    KEY(drive_amplitude, "1"),
    KEY(k, "1"),
    KEY(damping, "1"),
    KEY(m, "1"),
    KEY(mass, "kg"),
    KEY(radius, "m"),
    KEY(inertia, "kg m2"),
    KEY(friction, "kg m2 s-1"),
    KEY(gravity, "m s-2"),
    KEY(pivot_amplitude, "m"),
    KEY(pivot_frequency, "rad s-1"),
    KEY(frequency, "Hz"),
    KEY(length, "m"),
    KEY(amplitude, "m"),
    KEY(decay_time, "s"),
    KEY(tilt, "rad"),
    KEY(ellipse, "1"),
    KEY(torque, "1"),
};

const char *kz_sweep_words(void) {
  static char words[512];
  words[0] = '\0';
  for (int i = 0; i < KZ_SWEEP_PARAMETERS; i++) {
    if (i > 0) strcat(words, "|");
    strcat(words, kz_sweep_parameters[i].name);
  }
  return words;
}

bool kz_pendulum_at(const kz_scene *scene, int n, const int32_t *parameter, const double *value, kz_pendulum *pendulum) {
  kz_parameters parameters = scene->parameters;
  for (int i = 0; i < n; i++) *(double *)((char *)&parameters.written + kz_sweep_parameters[parameter[i]].offset) = value[i];
  if (kz_parameters_resolve(&parameters) != KZ_OK) {
    kz_message_clear();
    return false;
  }
  *pendulum = parameters.pendulum;
  return pendulum->beta >= 0 && (isnan(parameters.written.inertia) || kz_inertia_is_possible(&parameters.written));
}

bool kz_sweep_pendulum(const kz_scene *scene, double value, kz_pendulum *pendulum) {
  return kz_pendulum_at(scene, 1, &scene->sweep.parameter, &value, pendulum);
}

double kz_axis_value(const kz_axis *values, int64_t i) {
  if (i == values->count - 1) return values->max;
  return values->min + (values->max - values->min) * ((double)i / (double)(values->count - 1));
}

double kz_sweep_value(const kz_sweep_plan *plan, int64_t i) {
  return kz_axis_value(&plan->values, i);
}
