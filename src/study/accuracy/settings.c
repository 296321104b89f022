/* The table of settings, and one setting measured: its dynamics, labels of the sampled cells, time. */
#include "accuracy.h"
#include "labelling/search.h"
#include "cells/cell_starts.h"
#include "numerics/cells.h"
#include "numerics/resolve.h"

enum { MANY = 1 << 19 };       /* cells that are timed by method exact, where they do not take longer than LONG */
static const double LONG = 20; /* s */

#define DIRECT(ROW, label, scheme, steps) ROW(label, KZ_METHOD_DIRECT, scheme, steps, 0, KZ_QUINTIC, 1000, false)
#define PROCESSED(ROW, tolerance) \
  ROW("processed-" #tolerance, KZ_METHOD_DIRECT, "processed", KZ_AUTO, tolerance, KZ_QUINTIC, 1000, true)
#define ICM(ROW, label, interpolation, nodes) \
  ROW(label, KZ_METHOD_ICM, "processed", KZ_AUTO, 1e-12, interpolation, nodes, false)

#define SETTINGS(ROW)                                                             \
  PROCESSED(ROW, 1e-4)                                                            \
  PROCESSED(ROW, 1e-6)                                                            \
  PROCESSED(ROW, 1e-8)                                                            \
  PROCESSED(ROW, 1e-10)                                                           \
  PROCESSED(ROW, 1e-12)                                                           \
  DIRECT(ROW, "direct-rk4-100-1992", "rk4", 100)                                  \
  DIRECT(ROW, "direct-rk4-400", "rk4", 400)                                       \
  DIRECT(ROW, "direct-8", "split6", 8)                                            \
  DIRECT(ROW, "direct-24", "split6", 24)                                          \
  ROW("direct-96", KZ_METHOD_DIRECT, "split6", 96, 0, KZ_QUINTIC, 1000, true)     \
  ROW("icm-linear-500-1992", KZ_METHOD_ICM, "rk4", 100, 0, KZ_LINEAR, 500, false) \
  ICM(ROW, "icm-linear-1000", KZ_LINEAR, 1000)                                    \
  ICM(ROW, "icm-linear-2000", KZ_LINEAR, 2000)                                    \
  ICM(ROW, "icm-250", KZ_QUINTIC, 250)                                            \
  ICM(ROW, "icm-500", KZ_QUINTIC, 500)                                            \
  ICM(ROW, "icm-1000", KZ_QUINTIC, 1000)                                          \
  ICM(ROW, "icm-2000", KZ_QUINTIC, 2000)                                          \
  ROW("exact", KZ_METHOD_EXACT, "processed", KZ_AUTO, 1e-12, KZ_QUINTIC, 1000, false)

#define SETTING(...) {__VA_ARGS__},
const kz_setting kz_settings[] = {SETTINGS(SETTING)};
const int kz_setting_count = sizeof kz_settings / sizeof kz_settings[0];
const kz_setting *const kz_setting_exact = kz_settings + sizeof kz_settings / sizeof kz_settings[0] - 1;

#define LABEL(label, ...) "|" label
const char *kz_tradeoff_words(void) {
  return &(SETTINGS(LABEL))[1];
}

kz_numerics kz_setting_numerics(const kz_setting *setting, const kz_pendulum *pendulum, kz_kept_series *series,
                                const kz_basin_plan *plan) {
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  if (setting->steps == KZ_AUTO)
    return kz_processed_or_split(
        pendulum, series, setting->method, setting->tolerance,
        kz_fastest_motion(pendulum, &window, setting->method == KZ_METHOD_ICM ? setting->nodes : 0));
  return (kz_numerics){.scheme = kz_scheme_find(setting->scheme), .steps_per_period = setting->steps};
}

void kz_setting_apply(const kz_setting *setting, kz_scene *scene) {
  kz_basin_plan *plan = scene->basin;
  scene->numerics = kz_setting_numerics(setting, &scene->parameters.pendulum, scene->series, plan);
  plan->method = setting->method;
  plan->interpolation = setting->interpolation;
  plan->table_theta = plan->table_velocity = setting->nodes;
}

/* Kicks of split6 that a period costs. */
static double period_kicks(const kz_setting *setting) {
  /* Cost of a processed step in kicks, its steps at 1e-4 for a gentle drive, the order by which they grow. */
  static const double step = 0.4, steps = 14, order = 14;
  if (setting->steps == KZ_AUTO) return step * steps * pow(1e-4 / setting->tolerance, 1 / order);
  return (double)kz_scheme_at(kz_scheme_find(setting->scheme)).kicks * setting->steps;
}

double kz_setting_cost(const kz_setting *setting, double cells, double mean_periods) {
  /* Measured weights, kicks in double precision: a table look-up, the check whether a region holds the state. */
  static const double look_up = 30, look_up_node = 2.5, asked = 15;
  static const double exact = 25; /* times what the same numerics take without errors; 9 to 40 */
  const double nodes = (double)setting->nodes, period = period_kicks(setting);
  if (setting->method == KZ_METHOD_EXACT) return exact * cells * mean_periods * (asked + period);
  if (setting->method == KZ_METHOD_DIRECT) return cells * mean_periods * (asked + period);
  return 0.5 * nodes * nodes * period +
         cells * mean_periods * (asked + look_up + look_up_node * kz_stencil(setting->interpolation));
}

typedef struct {
  const kz_setting *setting;
  const kz_reference_labels *reference;
  kz_dynamics *dynamics;
} measurement;

/* Labels [n] of the first n cells in the order of the sample; KZ_DOUBTFUL where no level of method exact decides.
 * Method direct is compared by its states alone. */
static kz_status label_cells(const measurement *g, int64_t n, int32_t *label) {
  const kz_setting *s = g->setting;
  kz_labeller labeller = kz_cell_labeller(g->reference->plan, g->dynamics);
  KZ_AUTOFREE int64_t *cell = kz_malloc((size_t)n * sizeof *cell + 1);
  KZ_AUTOFREE kz_label *found = kz_malloc((size_t)n * sizeof *found + 1);
  if (s->method != KZ_METHOD_EXACT) labeller.way = KZ_BY_STATES;
  labeller.stepper = kz_stepper_of(s->method, s->interpolation);
  for (int64_t i = 0; i < n; i++) cell[i] = kz_reference_labels_cell(g->reference, i);
  KZ_TRY(kz_label_items(&labeller, 1, n, cell, found));
  for (int64_t i = 0; i < n; i++) label[i] = found[i].label;
  return KZ_OK;
}

/* Largest difference between the cells of one attractor among the labels and among the reference labels. */
static int64_t largest_count_error(const kz_reference_labels *reference, const int32_t *label, int64_t *surplus,
                                   int64_t known) {
  int64_t largest = 0;
  memset(surplus, 0, (size_t)(known + 1) * sizeof *surplus);
  for (int64_t i = 0; i < reference->samples; i++) {
    if (label[i] == KZ_DOUBTFUL) continue;
    surplus[label[i]]++;
    surplus[reference->labels[i].end.label]--;
  }
  for (int64_t a = 1; a <= known; a++)
    if (llabs(surplus[a]) > largest) largest = llabs(surplus[a]);
  return largest;
}

static void settings_compare(const kz_reference_labels *reference, const int32_t *label, kz_setting_measured *m) {
  int64_t at[KZ_REFERENCE_FAR + 1] = {0}, seen = 0;
  for (int64_t i = 0; i < reference->samples; i++) {
    if (label[i] == KZ_DOUBTFUL)
      m->undecided++;
    else if (label[i] != reference->labels[i].end.label)
      at[reference->labels[i].distance]++;
  }
  for (int distance = 1; distance <= KZ_REFERENCE_FAR; distance++) m->wrong += at[distance];
  m->inside = m->wrong - at[1];
  for (int distance = 1; distance <= KZ_REFERENCE_FAR && m->wrong > 0 && m->distance == 0; distance++)
    if (2 * (seen += at[distance]) >= m->wrong) m->distance = distance;
}

static kz_status set_up(measurement *g) {
  const kz_setting *s = g->setting;
  kz_dynamics_unpack(g->dynamics, g->reference->packed_size, g->reference->packed);
  kz_dynamics_regions(g->dynamics, 0, g->reference->max_velocity);
  kz_regions_grow(g->dynamics, g->reference->total, g->reference->max_velocity);
  kz_dynamics_update(g->dynamics);
  if (s->method == KZ_METHOD_ICM)
    KZ_TRY(kz_map_table_make(NULL, g->dynamics, s->nodes, s->nodes, g->reference->max_velocity));
  return KZ_OK;
}

static kz_status settings_measure(measurement *g, int64_t n, int32_t *label, int64_t *surplus, kz_setting_measured *m) {
  const double start = kz_processor_clock();
  KZ_TRY(set_up(g));
  const double ready = kz_processor_clock();
  KZ_TRY(label_cells(g, n, label));
  *m = (kz_setting_measured){.set_up = ready - start, .cell = (kz_processor_clock() - ready) / (double)n};
  settings_compare(g->reference, label, m);
  m->count_error = largest_count_error(g->reference, label, surplus, kz_dynamics_count(g->dynamics));
  return KZ_OK;
}

/* Measures the time with dynamics of its own on at least n cells. */
static kz_status measure_cells(const kz_setting *setting, const kz_reference_labels *reference, int64_t n,
                               kz_setting_measured *measured) {
  const kz_numerics numerics = kz_setting_numerics(setting, &reference->pendulum, reference->series, reference->plan);
  if (n < reference->samples) n = reference->samples;
  if (n > reference->total) n = reference->total;
  KZ_AUTOFREE_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_dynamics_create(&reference->pendulum, &numerics, reference->plan->max_period);
  measurement g = {setting, reference, dynamics};
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)n * sizeof *label + 1);
  KZ_AUTOFREE int64_t *surplus = kz_calloc(INT16_MAX + 1, sizeof *surplus);
  return settings_measure(&g, n, label, surplus, measured);
}

kz_status kz_setting_measure(const kz_setting *setting, const kz_reference_labels *reference, int64_t timed,
                             kz_setting_measured *measured) {
  KZ_TRY(measure_cells(setting, reference, timed, measured));
  /* The tables of more digits are made once for all cells. */
  if (setting->method != KZ_METHOD_EXACT || timed == 0 || measured->cell * MANY > LONG) return KZ_OK;
  return measure_cells(setting, reference, MANY, measured);
}
