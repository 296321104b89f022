/* Study `tradeoff`: many settings on the cells of one basin, each with its time and its share of wrong labels.
 *
 * reference labels of a sample -> one tile per setting, done by one rank alone -> table, file. */
#include "accuracy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "numerics/share.h"

enum { TIMED = 16384 }; /* cells that are enough for a measured time */

typedef struct {
  const kz_reference_labels *reference;
  const kz_trade *trade;
} measuring;

static int64_t count_settings(const kz_tradeoff_plan *plan) {
  return plan->settings.count > 0 ? plan->settings.count : kz_setting_count;
}

static const kz_setting *setting_at(const kz_tradeoff_plan *plan, int64_t i) {
  return kz_settings + (plan->settings.count > 0 ? plan->settings.values[i] : i);
}

kz_cost kz_tradeoff_cost(const kz_scene *scene) {
  double nodes = 0;
  for (int64_t i = 0; i < count_settings(&scene->tradeoff); i++) {
    const kz_setting *setting = setting_at(&scene->tradeoff, i);
    nodes = fmax(nodes, (double)setting->nodes * (double)setting->nodes);
  }
  return (kz_cost){.disk_bytes = 1e6, .memory_bytes = 120 * nodes};
}

/* Without damping there are no reference labels. */
kz_status kz_tradeoff_check(const kz_scene *scene) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  kz_numerics reference;
  return pendulum->beta > 0 ? kz_reference_labels_numerics(&scene->basin, pendulum, &reference) : KZ_OK;
}

char *kz_reference_path(const kz_store *store) {
  static const char ending[] = ".truth";
  if (!store) return NULL;
  const char *path = kz_store_path(store);
  char *name = kz_malloc(strlen(path) + sizeof ending);
  return strcat(strcpy(name, path), ending);
}

static kz_status measure_tile(void *context, int64_t tile, void *record) {
  const measuring *m = context;
  return kz_setting_measure(m->trade->settings[tile], m->reference, TIMED, record);
}

static void tradeoff_allocate(const kz_tradeoff_plan *plan, kz_trade *trade) {
  const size_t n = (size_t)count_settings(plan);
  *trade = (kz_trade){.count = (int64_t)n,
                      .settings = kz_calloc(n, sizeof *trade->settings),
                      .numerics = kz_calloc(n, sizeof *trade->numerics),
                      .measured = kz_calloc(n, sizeof *trade->measured),
                      .seconds = kz_calloc(n, sizeof(double)),
                      .wrong = kz_calloc(n, sizeof(double)),
                      .pareto = kz_calloc(n, sizeof(int8_t))};
  for (int64_t i = 0; i < trade->count; i++) trade->settings[i] = setting_at(plan, i);
}

static void free_trade(kz_trade *trade) {
  free(trade->settings);
  free(trade->numerics);
  free(trade->measured);
  free(trade->seconds);
  free(trade->wrong);
  free(trade->pareto);
}

/* Shares, times and the Pareto front from the counts and the measured times. */
static void rate(const kz_reference_labels *reference, kz_trade *trade) {
  const double cells = (double)kz_unique_cells(reference->plan);
  trade->best_wrong = NAN;
  for (int64_t i = 0; i < trade->count; i++) {
    const kz_measured *m = trade->measured + i;
    trade->wrong[i] = kz_share_of(m->wrong, reference->samples).share;
    trade->seconds[i] = m->set_up + m->cell * cells;
    if (trade->settings[i]->method != KZ_METHOD_EXACT) trade->best_wrong = fmin(trade->best_wrong, trade->wrong[i]);
  }
  kz_pareto(trade->count, trade->seconds, trade->wrong, trade->pareto);
}

static kz_stage stage_of(measuring *m) {
  return kz_stage_for_all("settings", m->trade->count, sizeof(kz_measured), measure_tile, m);
}

static kz_status run_settings(const kz_reference_labels *reference, kz_trade *trade, const kz_run *run) {
  measuring m = {reference, trade};
  const kz_stage stage = stage_of(&m);
  for (int64_t i = 0; i < trade->count; i++)
    trade->numerics[i] = kz_setting_numerics(trade->settings[i], &reference->pendulum, reference->plan);
  KZ_TRY(kz_stage_run(run, &stage, trade->measured));
  rate(reference, trade);
  return KZ_OK;
}

kz_status kz_tradeoff_measure(const kz_scene *scene, double *seconds) {
  kz_reference_labels reference = {0};
  kz_trade trade = {0};
  if (!(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  kz_status status = kz_reference_labels_measure(scene, scene->tradeoff.samples, &reference, seconds);
  if (status == KZ_OK) {
    measuring m = {&reference, &trade};
    tradeoff_allocate(&scene->tradeoff, &trade);
    const kz_stage stage = stage_of(&m);
    status = kz_stage_measure(&stage, 6, 2.0, seconds);
  }
  kz_reference_labels_free(&reference);
  free_trade(&trade);
  return status;
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  kz_reference_labels reference = {0};
  kz_trade trade = {0};
  char *path = kz_reference_path(store);
  tradeoff_allocate(&scene->tradeoff, &trade);
  kz_status status = kz_reference_labels_make(scene, run, scene->tradeoff.samples, path, &reference);
  if (status == KZ_OK) status = kz_ranks_agree(run->ranks, path ? kz_reference_labels_save(&reference, path) : KZ_OK);
  if (status == KZ_OK) status = run_settings(&reference, &trade, run);
  if (status == KZ_OK && store) status = kz_tradeoff_write(&reference, &trade, store, summary);
  kz_reference_labels_free(&reference);
  free_trade(&trade);
  free(path);
  return kz_ranks_agree(run->ranks, status);
}

kz_status kz_tradeoff_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta > 0) return run_damped(scene, run, store, summary);
  if (summary) fprintf(summary, "tradeoff: without damping there are no attractors, so there are no labels to compare.\n");
  return KZ_OK;
}
