/* Measure `phases` of a sweep, the share that ends alike at any phase of release: its row, and its keys. */
#define KEYS_OF alike

#include "kapitza/study_key_rows.h"
#include "phases.h"
#include "release.h"
#include "sweep/sweep.h"

#define WORD_OF_PART "phases"
static const char *alike_words(void) {
  return WORD_OF_PART;
}

static const kz_key keys[] = {
    KZ_ROW("sweep.measure", KZ_KEY_WORDS, NULL, KZ_ROW_NOWHERE,
           "Along one key also phases: share of cells or starts that ends alike at all phases of release.", .unit = "",
           .words_from = alike_words),
    KZ_ROW_INTEGER("sweep.phases", 2, 64, "8", phases,
                   "Phases of release for the measure phases, evenly over a period."),
    {.path = NULL},
};

/* Items with a common end; a cell of a folded grid counts for its mirror image too. */
static int64_t count_alike(const kz_phases *p, int64_t total) {
  int64_t alike = 0;
  for (int64_t i = 0; i < p->n; i++)
    if (kz_phases_common(p, i) > 0) alike += total - 1 - i < p->n ? 1 : 2;
  return alike;
}

/* Starts of the cells, with their mirror images, or without a grid those of the sweep: start [n][2]. */
static void find_starts(const kz_scene *scene, int64_t n_cells, int64_t n, double *start) {
  const kz_window window = kz_window_of(&scene->sweep->theta, &scene->sweep->velocity);
  for (int64_t i = 0; i < n_cells; i++) kz_cell_start(scene->basin, i, start + 2 * i);
  if (n_cells == 0) kz_dynamics_starts(&window, scene->sweep->seed, n, start); /* half-turns */
  for (int64_t i = n_cells; i < n; i++) start[2 * i] *= M_PI;
}

/* By attractors and regions that are known. */
static kz_status find_alike(const kz_scene *scene, const kz_sweep_value_at *at, kz_sweep_catalogue *catalogue) {
  const kz_sweep_plan *plan = scene->sweep;
  const int64_t n = at->n_cells > 0 ? at->n_cells : plan->starts, phases = scene->alike->phases;
  const int64_t max_periods = at->n_cells > 0 ? scene->basin->max_periods : at->max_periods;
  const int64_t total = at->n_cells > 0 ? scene->basin->theta.count * scene->basin->velocity.count : n;
  KZ_AUTOFREE double *start = kz_malloc(2 * (size_t)n * sizeof *start);
  int64_t alike = 0;
  find_starts(scene, at->n_cells, n, start);
  kz_phases p = {.labeller = kz_pair_labeller(start, max_periods, KZ_BY_STATES, at->dynamics),
                 .phases = phases,
                 .n = n,
                 .stage = "sweep phases"};
  p.labeller.at_strobe = false;
  kz_dynamics_get_release(at->dynamics, &p.release);
  p.folded =
      at->n_cells > 0 && kz_window_mirrors_itself(scene->basin) && kz_phases_fold(&at->pendulum, &p.release, phases);
  const kz_status status = kz_phases_label(&p, at->run);
  if (status == KZ_OK && p.label) alike = count_alike(&p, total);
  kz_phases_free(&p);
  KZ_TRY(status);
  KZ_TRY(kz_ranks_broadcast(at->run->ranks, &alike, sizeof alike));
  const kz_share share = kz_share_of(alike, catalogue->samples);
  catalogue->of_value[0] = share.share;
  catalogue->of_value[1] = share.low;
  catalogue->of_value[2] = share.high;
  return KZ_OK;
}

static int64_t alike_times(const kz_scene *scene) {
  return scene->alike->phases;
}

static const char *const ALIKE[] = {"alike", "alike_low", "alike_high", NULL};
const kz_sweep_part kz_alike_part = {.words = WORD_OF_PART,
                                     .of_branches = 1,
                                     .of_values = ALIKE,
                                     .on_grid = true,
                                     .times = alike_times,
                                     .value = find_alike};

static kz_status alike_describe(const kz_scene *scene, kz_store *store) {
  if (kz_sweep_part_words(scene->sweep, &kz_alike_part, true).count == 0) return KZ_OK;
  return kz_store_integer(store, "sweep", "phases", scene->alike->phases);
}

KZ_PART_ROW("sweep", has_sweep, .of_sweep = &kz_alike_part, .check = kz_alike_check, .describe = alike_describe);
