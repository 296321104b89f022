/* The table of configurations. */
#include <string.h>

#include "common/cells.h"
#include "config.h"

#define DIRECT(label, scheme, steps, precision, candidate) \
  {label, KZ_METHOD_DIRECT, scheme, steps, precision, KZ_QUINTIC, 1000, candidate}
#define ICM(label, interpolation, nodes) \
  {label, KZ_METHOD_ICM, "split6", 24, KZ_DOUBLE, interpolation, nodes, interpolation == KZ_QUINTIC}
#define HYBRID(label, nodes, steps) {label, KZ_METHOD_HYBRID, "split6", steps, KZ_DOUBLE, KZ_QUINTIC, nodes, true}

const kz_config kz_configs[] = {
    DIRECT("direct-rk4-100-1992", "rk4", 100, KZ_DOUBLE, false),
    DIRECT("direct-rk4-400", "rk4", 400, KZ_DOUBLE, false),
    DIRECT("direct-split4-24", "split4", 24, KZ_DOUBLE, false),
    DIRECT("direct-6", "split6", 6, KZ_DOUBLE, true),
    DIRECT("direct-8", "split6", 8, KZ_DOUBLE, true),
    DIRECT("direct-12", "split6", 12, KZ_DOUBLE, true),
    DIRECT("direct-16", "split6", 16, KZ_DOUBLE, true),
    DIRECT("direct-24", "split6", 24, KZ_DOUBLE, true),
    DIRECT("direct-48", "split6", 48, KZ_DOUBLE, true),
    DIRECT("direct-96", "split6", 96, KZ_DOUBLE, true),
    DIRECT("direct-single-8", "split6", 8, KZ_SINGLE, false),
    DIRECT("direct-single-16", "split6", 16, KZ_SINGLE, false),
    {"icm-linear-500-1992", KZ_METHOD_ICM, "rk4", 100, KZ_DOUBLE, KZ_LINEAR, 500, false},
    ICM("icm-linear-1000", KZ_LINEAR, 1000),
    ICM("icm-linear-2000", KZ_LINEAR, 2000),
    ICM("icm-cubic-500", KZ_CUBIC, 500),
    ICM("icm-cubic-1000", KZ_CUBIC, 1000),
    ICM("icm-cubic-2000", KZ_CUBIC, 2000),
    ICM("icm-250", KZ_QUINTIC, 250),
    ICM("icm-500", KZ_QUINTIC, 500),
    ICM("icm-1000", KZ_QUINTIC, 1000),
    ICM("icm-2000", KZ_QUINTIC, 2000),
    {"icm-single-500", KZ_METHOD_ICM, "split6", 8, KZ_SINGLE, KZ_QUINTIC, 500, false},
    HYBRID("hybrid-250", 250, 24),
    HYBRID("hybrid-500", 500, 24),
    HYBRID("hybrid-1000", 1000, 24),
    HYBRID("hybrid-500-48", 500, 48),
    HYBRID("hybrid-1000-48", 1000, 48),
    HYBRID("hybrid-1000-96", 1000, 96),
};
const int kz_config_count = sizeof kz_configs / sizeof kz_configs[0];

const char *kz_tradeoff_words(void) {
  static char words[1024];
  words[0] = '\0';
  for (int i = 0; i < kz_config_count; i++) {
    if (i > 0) strncat(words, "|", sizeof words - strlen(words) - 1);
    strncat(words, kz_configs[i].label, sizeof words - strlen(words) - 1);
  }
  return words;
}

kz_numerics kz_config_numerics(const kz_config *config) {
  return (kz_numerics){
      .scheme = kz_scheme_find(config->scheme), .steps_per_period = config->steps, .precision = config->precision};
}

void kz_config_apply(const kz_config *config, kz_scene *scene) {
  scene->numerics = kz_config_numerics(config);
  scene->basin.method = config->method;
  scene->basin.interpolation = config->interpolation;
  scene->basin.table_theta = scene->basin.table_velocity = config->nodes;
}

double kz_config_cost(const kz_config *config, double cells, double mean_periods) {
  /* Measured weights, in kicks in double precision: a look-up in the table with its region, what it takes to track its error, the
   * share of the periods that hybrid integrates (0 to 0.35). */
  static const double kind[] = {[KZ_SINGLE] = 0.5, [KZ_DOUBLE] = 1}, look_up = 45, look_up_node = 2.5, tracking = 15,
                      integrated = 0.15;
  kz_scheme scheme;
  kz_scheme_row(kz_scheme_find(config->scheme), &scheme);
  const double nodes = (double)config->nodes, period = kind[config->precision] * scheme.kicks * config->steps;
  const double mapped = look_up + look_up_node * kz_stencil(config->interpolation);
  const double cell = config->method == KZ_METHOD_DIRECT ? period
                      : config->method == KZ_METHOD_ICM  ? mapped
                                                         : mapped + tracking + integrated * period;
  const double table = config->method == KZ_METHOD_DIRECT ? 0 : 0.5 * nodes * nodes * period;
  return table + cells * mean_periods * cell;
}
