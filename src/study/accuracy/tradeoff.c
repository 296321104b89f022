/* Study `tradeoff`: many settings on the cells of one basin, each with its time and its share of wrong labels.
 *
 * reference labels of a sample -> one tile per setting, done by one rank alone -> table, file. */
#include "accuracy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "numerics/share.h"
#include "basin/plan.h"

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
  for (int64_t i = 0; i < count_settings(scene->tradeoff); i++) {
    const kz_setting *setting = setting_at(scene->tradeoff, i);
    nodes = fmax(nodes, (double)setting->nodes * (double)setting->nodes);
  }
  return (kz_cost){.disk_bytes = 1e6, .memory_bytes = 120 * nodes};
}

/* Without damping there are no reference labels. */
kz_status kz_tradeoff_check(const kz_scene *scene) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  kz_numerics reference;
  return pendulum->beta > 0 ? kz_reference_labels_numerics(scene->basin, pendulum, &reference) : KZ_OK;
}

char *kz_reference_path(const kz_store *store) {
  static const char ending[] = ".truth";
  const char *path = store ? kz_store_path(store) : NULL;
  if (!path) return NULL;
  char *name = kz_malloc(strlen(path) + sizeof ending);
  return strcat(strcpy(name, path), ending);
}

static kz_status measure_tile(void *context, int64_t tile, void *record) {
  const measuring *m = context;
  return kz_setting_measure(m->trade->row[tile].setting, m->reference, TIMED, record);
}

static kz_trade trade_of(const kz_tradeoff_plan *plan) {
  kz_trade trade = {.count = count_settings(plan)};
  trade.row = kz_calloc((size_t)trade.count, sizeof *trade.row);
  for (int64_t i = 0; i < trade.count; i++) trade.row[i].setting = setting_at(plan, i);
  return trade;
}

static void free_trade(kz_trade *trade) {
  free(trade->row);
}

void kz_pareto(kz_trade *trade) {
  for (kz_trade_row *a = trade->row; a < trade->row + trade->count; a++) {
    a->pareto = true;
    for (const kz_trade_row *b = trade->row; b < trade->row + trade->count; b++)
      if (b->seconds <= a->seconds && b->wrong <= a->wrong && (b->seconds < a->seconds || b->wrong < a->wrong))
        a->pareto = false;
  }
}

/* Shares, times and the Pareto front from the counts and the measured times. */
static void rate(const kz_reference_labels *reference, const kz_measured *measured, kz_trade *trade) {
  const double cells = (double)kz_unique_cells(reference->plan);
  trade->best_wrong = NAN;
  for (int64_t i = 0; i < trade->count; i++) {
    kz_trade_row *row = trade->row + i;
    row->numerics = kz_setting_numerics(row->setting, &reference->pendulum, reference->series, reference->plan);
    row->measured = measured[i];
    row->wrong = kz_share_of(measured[i].wrong, reference->samples).share;
    row->seconds = measured[i].set_up + measured[i].cell * cells;
    if (row->setting->method != KZ_METHOD_EXACT) trade->best_wrong = fmin(trade->best_wrong, row->wrong);
  }
  kz_pareto(trade);
}

static kz_status run_settings(const kz_reference_labels *reference, kz_trade *trade, const kz_run *run) {
  measuring m = {reference, trade};
  const kz_stage stage = kz_stage_for_all("settings", trade->count, sizeof(kz_measured), measure_tile, &m);
  KZ_FREED kz_measured *measured = kz_malloc((size_t)trade->count * sizeof *measured);
  KZ_TRY(kz_stage_run(run, &stage, measured));
  rate(reference, measured, trade);
  return KZ_OK;
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_FREED_BY(kz_reference_labels_free) kz_reference_labels reference = {0};
  KZ_FREED_BY(free_trade) kz_trade trade = trade_of(scene->tradeoff);
  KZ_FREED char *path = kz_reference_path(store);
  KZ_TRY(kz_reference_labels_make(scene, run, scene->tradeoff->samples, path, &reference));
  KZ_TRY(kz_ranks_agree(run->ranks, path ? kz_reference_labels_save(&reference, path) : KZ_OK));
  KZ_TRY(run_settings(&reference, &trade, run));
  return kz_ranks_agree(run->ranks, store ? kz_tradeoff_write(&reference, &trade, store, summary) : KZ_OK);
}

kz_status kz_tradeoff_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta > 0) return run_damped(scene, run, store, summary);
  if (summary) fprintf(summary, "tradeoff: without damping there are no attractors, so there are no labels to compare.\n");
  return KZ_OK;
}
