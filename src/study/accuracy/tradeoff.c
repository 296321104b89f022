/* Study `tradeoff`: many settings on the cells of one basin, each with its time and its share of wrong labels.
 *
 * reference labels of a sample -> one tile per setting, done by one rank alone -> table, file. */
#include "accuracy.h"

#include "numerics/cells.h"
#include "numerics/share.h"
#include "numerics/steps.h"

/* ---- its group in the file, its table for people ---- */

#define COLUMN(type, name, expression) KZ_COLUMN(store, "tradeoff", name, trade->count, type, expression)

static kz_status write_configs(const kz_trade *trade, kz_store *store) {
  const kz_trade_row *r = trade->row;
  KZ_AUTOFREE kz_scheme *scheme = kz_malloc((size_t)trade->count * sizeof *scheme + 1);
  for (int64_t i = 0; i < trade->count; i++) scheme[i] = kz_scheme_at(r[i].numerics.scheme);
  COLUMN(const char *, "label", r[i].setting->label);
  COLUMN(int8_t, "method", r[i].setting->method);
  COLUMN(const char *, "scheme", scheme[i].name);
  COLUMN(int32_t, "steps_per_period", r[i].numerics.steps_per_period);
  COLUMN(int8_t, "interpolation", r[i].setting->interpolation);
  COLUMN(int32_t, "table_nodes", r[i].setting->nodes);
  return KZ_OK;
}

static kz_status write_measures(const kz_reference_labels *reference, const kz_trade *trade, kz_store *store) {
  const kz_trade_row *r = trade->row;
  const double n = (double)reference->samples;
  COLUMN(double, "wrong", r[i].wrong);
  COLUMN(double, "wrong_low", kz_share_of(r[i].measured.wrong, reference->samples).low);
  COLUMN(double, "wrong_high", kz_share_of(r[i].measured.wrong, reference->samples).high);
  COLUMN(double, "undecided", (double)r[i].measured.undecided / n);
  COLUMN(double, "wrong_inside", (double)r[i].measured.inside / n);
  COLUMN(double, "wrong_distance", r[i].measured.wrong > 0 ? (double)r[i].measured.distance : NAN);
  COLUMN(double, "fraction_error", (double)r[i].measured.count_error / n);
  COLUMN(double, "seconds", r[i].seconds);
  COLUMN(double, "seconds_per_million_cells", 1e6 * r[i].measured.cell);
  COLUMN(int8_t, "pareto", r[i].pareto);
  return KZ_OK;
}

static kz_status write_attributes(const kz_reference_labels *reference, const kz_trade *trade, kz_store *store) {
  const kz_reference_labels_summary sum = kz_reference_labels_sum(reference);
  char method[200];
  snprintf(method, sizeof method,
           "quad precision, Taylor series in %d steps a period or more; with more steps %lld of %lld repeated cells "
           "have the "
           "same label",
           KZ_REFERENCE_STEPS, (long long)(sum.asked - sum.disagree), (long long)sum.asked);
  KZ_TRY(kz_store_text(store, "tradeoff", "reference", method));
  KZ_TRY(kz_store_integer(store, "tradeoff", "samples", reference->samples));
  KZ_TRY(kz_store_real(store, "tradeoff", "floor", kz_share_of(sum.flipped, reference->samples).share));
  KZ_TRY(kz_store_real(store, "tradeoff", "mean_periods", sum.mean_periods));
  return kz_store_real(store, "tradeoff", "best_wrong", trade->best_wrong);
}

static void print_row(const kz_reference_labels *reference, const kz_trade *trade, int64_t i, FILE *summary) {
  const kz_trade_row *r = trade->row + i;
  const kz_setting *s = r->setting;
  const kz_setting_measured *m = &r->measured;
  const kz_share wrong = kz_share_of(m->wrong, reference->samples);
  fprintf(summary, "%c %-20s %-7s %9s x %-3d %-8s %5lld  %7.3f  %6.3f .. %6.3f  %7.3f  %9.3f  %9.3f\n",
          r->pareto ? '*' : ' ', s->label, kz_method_names[s->method], kz_scheme_at(r->numerics.scheme).name,
          (int)r->numerics.steps_per_period,
          s->method != KZ_METHOD_ICM ? "-" : kz_interpolation_names[s->interpolation], (long long)s->nodes,
          100 * wrong.share, 100 * wrong.low, 100 * wrong.high,
          100 * (double)m->count_error / (double)reference->samples, r->seconds, 1e6 * m->cell);
}

/* Prints how many cells the settings of method exact leave undecided. */
static void print_undecided(const kz_reference_labels *reference, const kz_trade *trade, FILE *summary) {
  for (int64_t i = 0; i < trade->count; i++)
    if (trade->row[i].setting->method == KZ_METHOD_EXACT)
      fprintf(summary, "%s leaves %lld of %lld cells undecided; these count neither as right nor as wrong.\n",
              trade->row[i].setting->label, (long long)trade->row[i].measured.undecided, (long long)reference->samples);
}

/* Names the settings whose labels are random here. */
static void tradeoff_warn(const kz_reference_labels *reference, const kz_trade *trade, FILE *summary) {
  const double fastest = kz_axis_fastest(&reference->plan->velocity);
  const char *before = "warning: these settings have too few steps for the speeds of this window: ";
  for (int64_t i = 0; i < trade->count; i++) {
    if (kz_steps_carry(&reference->pendulum, &trade->row[i].numerics, fastest)) continue;
    fprintf(summary, "%s%s", before, trade->row[i].setting->label);
    before = ", ";
  }
  if (before[0] == ',') fprintf(summary, "\n");
}

static void tradeoff_print(const kz_reference_labels *reference, const kz_trade *trade, FILE *summary) {
  const kz_reference_labels_summary sum = kz_reference_labels_sum(reference);
  const kz_share flips = kz_share_of(sum.flipped, reference->samples);
  fprintf(
      summary,
      "tradeoff: wrong labels among %lld cells followed in quad precision, %.1f periods each; * = no other setting is "
      "both "
      "as fast and as accurate\n"
      "  setting              method  kind       integrator   table    nodes  wrong %%    95 %% interval    area %%    "
      "seconds  "
      "s/1e6 cells\n",
      (long long)reference->samples, sum.mean_periods);
  for (int64_t i = 0; i < trade->count; i++) print_row(reference, trade, i, summary);
  fprintf(summary,
          "One unit in the last place of the start changes %.3f %% of the labels (%.3f .. %.3f). The best setting in "
          "double "
          "precision has %.3f %% wrong. Another number of steps changed %lld of %lld reference labels.\n",
          100 * flips.share, 100 * flips.low, 100 * flips.high, 100 * trade->best_wrong, (long long)sum.disagree,
          (long long)sum.asked);
}

/* Group /tradeoff and its table in the summary. Rank 0. */
static kz_status write_tradeoff(const kz_reference_labels *reference, const kz_trade *trade, kz_store *store,
                                FILE *summary) {
  KZ_TRY(kz_store_dimension(store, "tradeoff", "setting", trade->count, NULL));
  KZ_TRY(write_configs(trade, store));
  KZ_TRY(write_measures(reference, trade, store));
  KZ_TRY(write_attributes(reference, trade, store));
  tradeoff_print(reference, trade, summary);
  print_undecided(reference, trade, summary);
  tradeoff_warn(reference, trade, summary);
  return KZ_OK;
}

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

static void find_pareto(kz_trade *trade) {
  for (kz_trade_row *a = trade->row; a < trade->row + trade->count; a++) {
    a->pareto = true;
    for (const kz_trade_row *b = trade->row; b < trade->row + trade->count; b++)
      if (b->seconds <= a->seconds && b->wrong <= a->wrong && (b->seconds < a->seconds || b->wrong < a->wrong))
        a->pareto = false;
  }
}

/* Shares, times and the Pareto front from the counts and the measured times. */
static void tradeoff_rate(const kz_reference_labels *reference, const kz_setting_measured *measured, kz_trade *trade) {
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
  find_pareto(trade);
}

static kz_status run_settings(const kz_reference_labels *reference, kz_trade *trade, const kz_run *run) {
  measuring m = {reference, trade};
  const kz_stage stage = kz_stage_for_all("settings", trade->count, sizeof(kz_setting_measured), measure_tile, &m);
  KZ_AUTOFREE kz_setting_measured *measured = kz_malloc((size_t)trade->count * sizeof *measured);
  KZ_TRY(kz_stage_run(run, &stage, measured));
  tradeoff_rate(reference, measured, trade);
  return KZ_OK;
}

static kz_status run_damped(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(kz_reference_labels_free) kz_reference_labels reference = {0};
  KZ_AUTOFREE_BY(free_trade) kz_trade trade = trade_of(scene->tradeoff);
  KZ_AUTOFREE char *path = kz_reference_path(store);
  KZ_TRY(kz_reference_labels_make(scene, run, scene->tradeoff->samples, path, &reference));
  KZ_TRY(kz_ranks_agree(run->ranks, path ? kz_reference_labels_save(&reference, path) : KZ_OK));
  KZ_TRY(run_settings(&reference, &trade, run));
  return kz_ranks_agree(run->ranks, store ? write_tradeoff(&reference, &trade, store, summary) : KZ_OK);
}

kz_status kz_tradeoff_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta > 0) return run_damped(scene, run, store, summary);
  if (summary)
    fprintf(summary, "tradeoff: without damping there are no attractors, so there are no labels to compare.\n");
  return KZ_OK;
}
