/* The table of settings. */
#include <math.h>
#include <string.h>

#include "numerics/cells.h"
#include "numerics/processed.h"
#include "setting.h"

#define DIRECT(label, scheme, steps) {label, KZ_METHOD_DIRECT, scheme, steps, 0, KZ_QUINTIC, 1000, false}
#define PROCESSED(tolerance) \
  {"processed-" #tolerance, KZ_METHOD_DIRECT, "processed", KZ_AUTO, tolerance, KZ_QUINTIC, 1000, true}
#define ICM(label, interpolation, nodes) {label, KZ_METHOD_ICM, "processed", KZ_AUTO, 1e-12, interpolation, nodes, false}

const kz_setting kz_settings[] = {
    PROCESSED(1e-4),
    PROCESSED(1e-6),
    PROCESSED(1e-8),
    PROCESSED(1e-10),
    PROCESSED(1e-12),
    DIRECT("direct-rk4-100-1992", "rk4", 100),
    DIRECT("direct-rk4-400", "rk4", 400),
    DIRECT("direct-8", "split6", 8),
    DIRECT("direct-24", "split6", 24),
    {"direct-96", KZ_METHOD_DIRECT, "split6", 96, 0, KZ_QUINTIC, 1000, true},
    {"icm-linear-500-1992", KZ_METHOD_ICM, "rk4", 100, 0, KZ_LINEAR, 500, false},
    ICM("icm-linear-1000", KZ_LINEAR, 1000),
    ICM("icm-linear-2000", KZ_LINEAR, 2000),
    ICM("icm-250", KZ_QUINTIC, 250),
    ICM("icm-500", KZ_QUINTIC, 500),
    ICM("icm-1000", KZ_QUINTIC, 1000),
    ICM("icm-2000", KZ_QUINTIC, 2000),
    {"exact", KZ_METHOD_EXACT, "processed", KZ_AUTO, 1e-12, KZ_QUINTIC, 1000, false},
};
const int kz_setting_count = sizeof kz_settings / sizeof kz_settings[0];
const kz_setting *const kz_setting_exact = kz_settings + sizeof kz_settings / sizeof kz_settings[0] - 1;

const char *kz_tradeoff_words(void) {
  static char words[1024];
  words[0] = '\0';
  for (int i = 0; i < kz_setting_count; i++) {
    if (i > 0) strncat(words, "|", sizeof words - strlen(words) - 1);
    strncat(words, kz_settings[i].label, sizeof words - strlen(words) - 1);
  }
  return words;
}

kz_numerics kz_setting_numerics(const kz_setting *setting, const kz_pendulum *pendulum, const kz_basin_plan *plan) {
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  if (setting->steps == KZ_AUTO)
    return kz_processed_or_split(pendulum, setting->method, setting->tolerance,
                                 kz_fastest_motion(pendulum, &window, setting->method == KZ_METHOD_ICM ? setting->nodes : 0));
  return (kz_numerics){.scheme = kz_scheme_find(setting->scheme), .steps_per_period = setting->steps};
}

void kz_setting_apply(const kz_setting *setting, kz_scene *scene) {
  kz_basin_plan *plan = &scene->basin;
  scene->numerics = kz_setting_numerics(setting, &scene->parameters.pendulum, plan);
  plan->method = setting->method;
  plan->interpolation = setting->interpolation;
  plan->table_theta = plan->table_velocity = setting->nodes;
}

/* Kicks of split6 that a period costs. */
static double period_kicks(const kz_setting *setting) {
  /* Of the processed splitting: what a step costs, steps at 1e-4 for a gentle drive, and the order by which they grow. */
  static const double step = 0.4, steps = 14, order = 14;
  if (setting->steps == KZ_AUTO) return step * steps * pow(1e-4 / setting->tolerance, 1 / order);
  return (double)kz_scheme_at(kz_scheme_find(setting->scheme)).kicks * setting->steps;
}

double kz_setting_cost(const kz_setting *setting, double cells, double mean_periods) {
  /* Measured weights, in kicks in double precision: a look-up in the table, the question whether a region holds the state. */
  static const double look_up = 30, look_up_node = 2.5, asked = 15;
  static const double exact = 25; /* times what the same numerics take without errors; 9 to 40 */
  const double nodes = (double)setting->nodes, period = period_kicks(setting);
  if (setting->method == KZ_METHOD_EXACT) return exact * cells * mean_periods * (asked + period);
  if (setting->method == KZ_METHOD_DIRECT) return cells * mean_periods * (asked + period);
  return 0.5 * nodes * nodes * period +
         cells * mean_periods * (asked + look_up + look_up_node * kz_stencil(setting->interpolation));
}
