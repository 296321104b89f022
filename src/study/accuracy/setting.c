/* One setting measured: its own dynamics with the reference's attractors, its labels of the sampled cells, its time. */
#include "setting.h"

#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "labelling/labeller.h"
#include "labelling/map_table.h"
#include "attractors/search.h"

enum {
  CHUNK = 16384, /* cells labelled at a time */
  MANY = 1 << 19 /* cells that are timed by method exact, where they do not take longer than LONG */
};
static const double LONG = 20; /* s */

/* Arrays of one chunk: too large for the stack. */
typedef struct {
  double state[2 * CHUNK];
  int64_t periods[CHUNK];
} workspace;

typedef struct {
  const kz_setting *setting;
  const kz_reference_labels *reference;
  kz_dynamics *dynamics;
  workspace *work;
} measurement;

/* A kz_start_fn: the items are places in the sample. */
static kz_status start_of_sample(void *context, int64_t item, int32_t level, kz_start *start) {
  const measurement *g = context;
  double centre[2];
  (void)level;
  kz_cell_start(g->reference->plan, kz_reference_labels_cell(g->reference, item), centre);
  *start = kz_start_at(centre[0], centre[1]);
  return KZ_OK;
}

/* Labels [n] of the first n cells in the order of the sample by method exact; KZ_DOUBTFUL where no level decides. */
static kz_status decide_cells(measurement *g, int64_t n, int32_t *label) {
  const kz_labeller labeller = {
      .dynamics = g->dynamics, .max_periods = g->reference->plan->max_periods, .start = start_of_sample, .context = g};
  kz_decision *decision = kz_malloc((size_t)n * sizeof *decision + 1);
  const kz_status status = kz_label(&labeller, n, NULL, decision);
  for (int64_t i = 0; i < n && status == KZ_OK; i++) label[i] = decision[i].label;
  free(decision);
  return status;
}

/* The same by integration or a map table, without errors. */
static void follow_cells(const measurement *g, int64_t n, int32_t *label) {
  const kz_setting *s = g->setting;
  workspace *w = g->work;
  for (int64_t first = 0; first < n; first += CHUNK) {
    const int64_t some = n - first < CHUNK ? n - first : CHUNK;
    for (int64_t i = 0; i < some; i++)
      kz_cell_state(g->reference->plan, kz_reference_labels_cell(g->reference, first + i), w->state + 2 * i);
    kz_dynamics_follow(g->dynamics, kz_stepping(s->method, s->interpolation), some, g->reference->plan->max_periods, w->state,
                       label + first, w->periods);
  }
}

/* The largest difference between the number of cells of one attractor among the labels and among the reference labels. */
static int64_t largest_count_error(const kz_reference_labels *reference, const int32_t *label, int64_t *surplus,
                                   int64_t known) {
  int64_t largest = 0;
  memset(surplus, 0, (size_t)(known + 1) * sizeof *surplus);
  for (int64_t i = 0; i < reference->samples; i++) {
    if (label[i] == KZ_DOUBTFUL) continue;
    surplus[label[i]]++;
    surplus[reference->labels[i].label]--;
  }
  for (int64_t a = 1; a <= known; a++)
    if (llabs(surplus[a]) > largest) largest = llabs(surplus[a]);
  return largest;
}

static void compare(const kz_reference_labels *reference, const int32_t *label, kz_measured *m) {
  int64_t at[KZ_REFERENCE_FAR + 1] = {0}, seen = 0;
  for (int64_t i = 0; i < reference->samples; i++) {
    if (label[i] == KZ_DOUBTFUL)
      m->undecided++;
    else if (label[i] != reference->labels[i].label)
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
  kz_dynamics_coarse_regions(g->dynamics, g->reference->max_velocity);
  kz_regions_grow(g->dynamics, g->reference->total, g->reference->max_velocity);
  kz_dynamics_update(g->dynamics);
  if (s->method == KZ_METHOD_ICM) KZ_TRY(kz_map_table_make(NULL, g->dynamics, s->nodes, s->nodes, g->reference->max_velocity));
  return KZ_OK;
}

static kz_status measure(measurement *g, int64_t n, int32_t *label, int64_t *surplus, kz_measured *m) {
  const double start = kz_processor_clock();
  KZ_TRY(set_up(g));
  const double ready = kz_processor_clock();
  if (g->setting->method == KZ_METHOD_EXACT)
    KZ_TRY(decide_cells(g, n, label));
  else
    follow_cells(g, n, label);
  *m = (kz_measured){.set_up = ready - start, .cell = (kz_processor_clock() - ready) / (double)n};
  compare(g->reference, label, m);
  m->count_error = largest_count_error(g->reference, label, surplus, kz_dynamics_count(g->dynamics));
  return KZ_OK;
}

/* Measures the time with dynamics of its own on at least n cells. */
static kz_status measure_cells(const kz_setting *setting, const kz_reference_labels *reference, int64_t n,
                               kz_measured *measured) {
  measurement g = {.setting = setting, .reference = reference};
  const kz_numerics numerics = kz_setting_numerics(setting, &reference->pendulum, reference->plan);
  if (n < reference->samples) n = reference->samples;
  if (n > reference->total) n = reference->total;
  g.dynamics = kz_dynamics_create(&reference->pendulum, &numerics, reference->plan->max_period);
  g.work = kz_malloc(sizeof *g.work);
  int32_t *label = kz_malloc((size_t)n * sizeof *label + 1);
  int64_t *surplus = kz_calloc(INT16_MAX + 1, sizeof *surplus);
  const kz_status status = measure(&g, n, label, surplus, measured);
  kz_dynamics_free(g.dynamics);
  free(g.work);
  free(label);
  free(surplus);
  return status;
}

kz_status kz_setting_measure(const kz_setting *setting, const kz_reference_labels *reference, int64_t timed,
                             kz_measured *measured) {
  KZ_TRY(measure_cells(setting, reference, timed, measured));
  /* The tables of more digits are made once for all cells. */
  if (setting->method != KZ_METHOD_EXACT || timed == 0 || measured->cell * MANY > LONG) return KZ_OK;
  return measure_cells(setting, reference, MANY, measured);
}
