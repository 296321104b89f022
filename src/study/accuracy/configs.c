/* The table of configurations. */
#include <math.h>
#include <string.h>

#include "numerics/cells.h"
#include "numerics/processed.h"
#include "config.h"

#define DIRECT(label, scheme, steps) {label, KZ_METHOD_DIRECT, scheme, steps, 0, KZ_QUINTIC, 1000, false}
#define PROCESSED(tolerance) \
  {"processed-" #tolerance, KZ_METHOD_DIRECT, "processed", KZ_AUTO, tolerance, KZ_QUINTIC, 1000, true}
#define ICM(label, interpolation, nodes) {label, KZ_METHOD_ICM, "processed", KZ_AUTO, 1e-12, interpolation, nodes, false}

const kz_config kz_configs[] = {
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
const int kz_config_count = sizeof kz_configs / sizeof kz_configs[0];
const kz_config *const kz_config_exact = kz_configs + sizeof kz_configs / sizeof kz_configs[0] - 1;

const char *kz_tradeoff_words(void) {
  static char words[1024];
  words[0] = '\0';
  for (int i = 0; i < kz_config_count; i++) {
    if (i > 0) strncat(words, "|", sizeof words - strlen(words) - 1);
    strncat(words, kz_configs[i].label, sizeof words - strlen(words) - 1);
  }
  return words;
}

kz_numerics kz_config_numerics(const kz_config *config, const kz_pendulum *pendulum, const kz_basin_plan *plan) {
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  if (config->steps == KZ_AUTO)
    return kz_processed_or_split(pendulum, config->tolerance,
                                 kz_fastest_motion(pendulum, &window, config->method == KZ_METHOD_ICM ? config->nodes : 0));
  return (kz_numerics){.scheme = kz_scheme_find(config->scheme), .steps_per_period = config->steps};
}

void kz_config_apply(const kz_config *config, kz_scene *scene) {
  kz_basin_plan *plan = &scene->basin;
  scene->numerics = kz_config_numerics(config, &scene->parameters.pendulum, plan);
  plan->method = config->method;
  plan->interpolation = config->interpolation;
  plan->table_theta = plan->table_velocity = config->nodes;
}

/* Kicks of split6 that a period costs. */
static double period_kicks(const kz_config *config) {
  /* Of the processed splitting: what a step costs, steps at 1e-4 for a gentle drive, and the order by which they grow. */
  static const double step = 0.4, steps = 14, order = 14;
  kz_scheme scheme;
  if (config->steps == KZ_AUTO) return step * steps * pow(1e-4 / config->tolerance, 1 / order);
  kz_scheme_row(kz_scheme_find(config->scheme), &scheme);
  return (double)scheme.kicks * config->steps;
}

double kz_config_cost(const kz_config *config, double cells, double mean_periods) {
  /* Measured weights, in kicks in double precision: a look-up in the table, the question whether a region holds the state. */
  static const double look_up = 30, look_up_node = 2.5, asked = 15;
  static const double exact = 25; /* times what the same numerics take without errors; 9 to 40 */
  const double nodes = (double)config->nodes, period = period_kicks(config);
  if (config->method == KZ_METHOD_EXACT) return exact * cells * mean_periods * (asked + period);
  if (config->method == KZ_METHOD_DIRECT) return cells * mean_periods * (asked + period);
  return 0.5 * nodes * nodes * period +
         cells * mean_periods * (asked + look_up + look_up_node * kz_stencil(config->interpolation));
}
