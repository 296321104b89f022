/* The values of sweeps, along a line or over a plane: which keys they are of, and the pendulum at each. */
#include "sweep/plan.h"

/* Keys that change the motions of a pendulum. */
#define MOTION_PARAMETERS(KEY)    \
  KEY(quality_factor, "1")        \
  KEY(drive_frequency, "1")       \
  KEY(drive_amplitude, "1")       \
  KEY(k, "1")                     \
  KEY(damping, "1")               \
  KEY(m, "1")                     \
  KEY(mass, "kg")                 \
  KEY(radius, "m")                \
  KEY(inertia, "kg m2")           \
  KEY(friction, "kg m2 s-1")      \
  KEY(gravity, "m s-2")           \
  KEY(pivot_amplitude, "m")       \
  KEY(pivot_frequency, "rad s-1") \
  KEY(frequency, "Hz")            \
  KEY(length, "m")                \
  KEY(amplitude, "m")             \
  KEY(decay_time, "s")            \
  KEY(tilt, "rad")                \
  KEY(ellipse, "1")               \
  KEY(torque, "1")                \
  KEY(torque_amplitude, "1")      \
  KEY(constant_torque_ratio, "1") \
  KEY(torque_ratio, "1")          \
  KEY(constant_torque, "N m")     \
  KEY(oscillating_torque, "N m")  \
  KEY(beta_c, "1")                \
  KEY(omega, "1")                 \
  KEY(i_dc, "1")                  \
  KEY(i_ac, "1")
#define KEY_ROW(name_, unit_) {#name_, unit_, offsetof(kz_pendulum_keys, name_)},
static const kz_sweep_parameter own[] = {MOTION_PARAMETERS(KEY_ROW)};
enum { OWN = sizeof own / sizeof *own };

const kz_sweep_parameter *kz_sweep_parameter_at(int32_t parameter) {
  if (parameter < OWN) return own + parameter;
  int32_t n = OWN;
  for (int i = 0; i < kz_study_count; i++)
    for (const kz_sweep_parameter *row = kz_studies[i]->parameters; row && row->name; row++)
      if (n++ == parameter) return row;
  return NULL;
}

#define KEY_WORD(name_, unit_) "|" #name_
const char *kz_sweep_words(void) {
  return kz_motion_words();
}

const char *kz_motion_words(void) {
  return &(MOTION_PARAMETERS(KEY_WORD))[1];
}

bool kz_sweep_is_of_drive(int32_t parameter) {
  for (const kz_drive_key *key = kz_drive_keys; key->path; key++)
    if (parameter < OWN && own[parameter].offset == key->offset) return true;
  return false;
}

/* The scene's parameters with n keys at other values; false where they are none. */
static bool parameters_at(const kz_scene *scene, int n, const int32_t *parameter, const double *value,
                          kz_parameters *parameters) {
  *parameters = scene->parameters;
  for (int i = 0; i < n; i++)
    if (parameter[i] < OWN) *(double *)((char *)&parameters->written + own[parameter[i]].offset) = value[i];
  if (kz_parameters_resolve(parameters) == KZ_OK) return true;
  kz_message_clear();
  return false;
}

bool kz_pendulum_at(const kz_scene *scene, int n, const int32_t *parameter, const double *value,
                    kz_pendulum *pendulum) {
  kz_parameters parameters;
  if (!parameters_at(scene, n, parameter, value, &parameters)) return false;
  *pendulum = parameters.pendulum;
  return pendulum->beta >= 0 && (isnan(parameters.written.inertia) || kz_inertia_is_possible(&parameters.written));
}

bool kz_sweep_pendulum(const kz_scene *scene, double value, kz_pendulum *pendulum) {
  return kz_pendulum_at(scene, 1, &scene->sweep->parameter, &value, pendulum);
}

double kz_axis_value(const kz_axis *values, int64_t i) {
  if (i == values->count - 1) return values->max;
  return values->min + (values->max - values->min) * ((double)i / (double)(values->count - 1));
}

double kz_sweep_value(const kz_sweep_plan *plan, int64_t i) {
  return plan->listed.count > 0 ? plan->listed.values[i] : kz_axis_value(&plan->values, i);
}

double kz_axis_written(const kz_axis *values, double value) {
  return values->written.name[0] ? value / values->written.factor : value;
}

const char *kz_axis_unit(const kz_axis *values, int32_t parameter) {
  const char *unit = kz_sweep_parameter_at(parameter)->unit;
  return values->written.name[0] ? values->written.name : strcmp(unit, "1") == 0 ? "" : unit;
}

void kz_axis_print(const kz_axis *values, int32_t parameter, int digits, double value, char *text, size_t bytes) {
  const char *unit = kz_axis_unit(values, parameter);
  snprintf(text, bytes, "%s = %.*g%s%s", kz_sweep_parameter_at(parameter)->name, digits, kz_axis_written(values, value),
           unit[0] ? " " : "", unit);
}

kz_status kz_axis_describe(const kz_axis *values, int32_t parameter, const char *axis, const char *group,
                           kz_store *store) {
  const char *of = axis[0] ? axis : "parameter";
  char name[32];
  snprintf(name, sizeof name, "%s%sparameter", axis, axis[0] ? "_" : "");
  KZ_TRY(kz_store_text(store, group, name, kz_sweep_parameter_at(parameter)->name));
  snprintf(name, sizeof name, "%s_units", of);
  KZ_TRY(kz_store_text(store, group, name, kz_sweep_parameter_at(parameter)->unit));
  if (!values->written.name[0]) return KZ_OK;
  snprintf(name, sizeof name, "%s_written_units", of);
  KZ_TRY(kz_store_text(store, group, name, values->written.name));
  snprintf(name, sizeof name, "%s_written_scale", of);
  return kz_store_real(store, group, name, values->written.factor);
}
