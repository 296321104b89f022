/* Study `basin`: the attractors of a window, then a label for every cell.
 *
 * scene -> discovery -> trapping regions -> map table -> tiles of cells -> (cells that ended nowhere known feed another round) ->
 * measures -> file. A window that is its own mirror image needs half the cells: cell f mirrors cell n - 1 - f. */
#include "basin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/accuracy.h"
#include "common/catalogue.h"
#include "common/search.h"
#include "common/step_table.h"
#include "kapitza/dynamics.h"
#include "common/settling.h"

enum {
  CELLS = 16384, /* of a tile, at most: so many that the few that take long hardly leave lanes empty */
  ROUNDS = 4     /* of discovery from unsettled cells, at most */
};

/* How a label was found: the values of the file's variable `evidence`. */
enum { UNSETTLED = 0, INSIDE = 1, FOLLOWED = 2, UNDECIDED = 3 };

/* A cell. */
typedef struct {
  uint32_t periods;
  int16_t label;    /* number of kz_dynamics, 0 = not settled */
  uint8_t evidence; /* FOLLOWED or UNDECIDED */
} labelled;

/* Arrays of one tile: too large for the stack. */
typedef struct {
  double start[2 * CELLS], state[2 * CELLS];
  int32_t label[CELLS], to[CELLS];
  int64_t periods[CELLS], place[CELLS];
  bool undecided[CELLS];
} workspace;

typedef struct {
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
  workspace *work;       /* of this rank */
  kz_search search;      /* of the starts */
  int64_t tile;          /* cells of a tile */
  int64_t total, own;    /* cells of the window; those that are labelled, the others mirror them */
  int16_t *label;        /* [own], rank 0 */
  uint32_t *periods;     /* [own], rank 0 */
  int64_t n_open, *open; /* cells of the present stage; NULL = all own ones */
  uint8_t *evidence;     /* [own], rank 0, as in labelled */
  int64_t *reached;      /* [INT16_MAX + 1] starts and cells that ended on each attractor */
} basin;

/* Integrates the marked ones of n starts from one unit in the last place beside; marked: those that end elsewhere then. */
static void find_undecided(const basin *b, int64_t n) {
  workspace *w = b->work;
  int64_t asked = 0;
  for (int64_t i = 0; i < n; i++) {
    if (!w->undecided[i]) continue;
    for (int c = 0; c < 2; c++)
      w->state[2 * asked + c] = nextafter(w->start[2 * i + c], copysign(INFINITY, w->start[2 * i + c]));
    w->place[asked++] = i;
  }
  kz_dynamics_follow(b->dynamics, KZ_FOLLOW_DIRECT, asked, b->plan->max_periods, w->state, w->to, w->periods);
  for (int64_t i = 0; i < asked; i++) w->undecided[w->place[i]] = w->to[i] != w->label[w->place[i]];
}

static kz_status label_tile(void *context, int64_t tile, void *record) {
  const basin *b = context;
  const kz_basin_plan *plan = b->plan;
  labelled *out = record;
  workspace *w = b->work;
  const int64_t first = tile * b->tile, left = b->n_open - first, n = left < b->tile ? left : b->tile;
  for (int64_t i = 0; i < n; i++) kz_cell_state(plan, b->open ? b->open[first + i] : first + i, w->start + 2 * i);
  memcpy(w->state, w->start, 2 * (size_t)n * sizeof *w->state);
  kz_dynamics_follow(b->dynamics, kz_way(plan->method, plan->interpolation), n, plan->max_periods, w->state, w->label,
                     w->periods);
  for (int64_t i = 0; i < n; i++) {
    w->undecided[i] = plan->flag_undecided && w->label[i] > 0 && w->periods[i] > 0 && plan->method == KZ_METHOD_DIRECT;
    out[i].label = (int16_t)w->label[i];
    out[i].periods = (uint32_t)w->periods[i];
  }
  if (plan->flag_undecided) find_undecided(b, n);
  for (int64_t i = 0; i < n; i++) out[i].evidence = w->undecided[i] ? UNDECIDED : FOLLOWED;
  return KZ_OK;
}

/* Labels the open cells; on rank 0 they go to their places. */
static kz_status label_cells(basin *b, kz_ranks *ranks, int round) {
  char name[32];
  snprintf(name, sizeof name, "cells %d", round + 1);
  kz_stage stage = {.name = name,
                    .n_tiles = (b->n_open + b->tile - 1) / b->tile,
                    .record_bytes = (size_t)b->tile * sizeof(labelled),
                    .work = label_tile,
                    .context = b,
                    .keep = true};
  labelled *records = NULL;
  if (kz_ranks_own(ranks) == 0) records = malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_status status = KZ_OK;
  if (kz_ranks_own(ranks) == 0 && !records) status = kz_fail(KZ_FAILED, "no memory for %lld cells", (long long)b->n_open);
  status = kz_ranks_agree(ranks, status);
  if (status == KZ_OK) status = kz_stage_run(ranks, &stage, records);
  for (int64_t i = 0; status == KZ_OK && records && i < b->n_open; i++) {
    int64_t f = b->open ? b->open[i] : i;
    b->label[f] = records[i].label;
    b->periods[f] = records[i].periods;
    b->evidence[f] = records[i].evidence;
  }
  free(records);
  return status;
}

/* The cells that have not settled, as the open ones of every rank. */
static kz_status open_unsettled(basin *b, kz_ranks *ranks) {
  int64_t n = 0;
  for (int64_t f = 0; kz_ranks_own(ranks) == 0 && f < b->own; f++) n += b->label[f] == 0;
  KZ_TRY(kz_ranks_broadcast(ranks, &n, sizeof n));
  free(b->open);
  b->open = malloc((size_t)n * sizeof *b->open + 1);
  b->n_open = n;
  KZ_TRY(kz_ranks_agree(ranks, b->open ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld cells", (long long)n)));
  n = 0;
  for (int64_t f = 0; kz_ranks_own(ranks) == 0 && f < b->own; f++)
    if (b->label[f] == 0) b->open[n++] = f;
  return kz_ranks_broadcast(ranks, b->open, (size_t)b->n_open * sizeof *b->open);
}

/* The attractors that starts over the window end on, or `again` unsettled cells, evenly chosen; what they reach is counted. */
static kz_status discover(basin *b, kz_ranks *ranks, bool again) {
  const kz_basin_plan *plan = b->plan;
  const int64_t n = again && b->n_open < plan->starts ? b->n_open : plan->starts;
  double *state = malloc((size_t)n * 2 * sizeof *state);
  int32_t *label = malloc((size_t)n * sizeof *label);
  kz_status status =
      kz_ranks_agree(ranks, state && label ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)n));
  for (int64_t i = 0; again && status == KZ_OK && i < n; i++) kz_cell_state(plan, b->open[i * b->n_open / n], state + 2 * i);
  if (status == KZ_OK)
    status = again ? kz_discover(ranks, b->dynamics, plan->max_periods, n, state, label)
                   : kz_search_window(ranks, b->dynamics, &b->search, state, label);
  if (status == KZ_OK && kz_dynamics_count(b->dynamics) > INT16_MAX)
    status = kz_fail(KZ_FAILED, "basin: more than %d attractors", INT16_MAX);
  for (int64_t i = 0; status == KZ_OK && i < n; i++) b->reached[label[i]]++;
  free(state);
  free(label);
  return status;
}

/* Before cells are labelled by a table alone. What basin.accuracy chose is judged by its labels. */
static kz_status check_table(const basin *b) {
  if (b->plan->method != KZ_METHOD_ICM || !isnan(b->plan->accuracy)) return KZ_OK;
  return kz_steps_check_table(b->plan, kz_dynamics_table_defect(b->dynamics, kz_stencil(b->plan->interpolation)));
}

/* Everything up to the labels. */
static kz_status model(basin *b, kz_ranks *ranks) {
  KZ_TRY(discover(b, ranks, false));
  KZ_TRY(kz_ranks_agree(ranks, check_table(b)));
  b->n_open = b->own;
  for (int round = 0;; round++) {
    KZ_TRY(label_cells(b, ranks, round));
    if (round == ROUNDS - 1) return KZ_OK;
    KZ_TRY(open_unsettled(b, ranks));
    if (b->n_open == 0) return KZ_OK;
    int64_t known = kz_dynamics_count(b->dynamics);
    KZ_TRY(discover(b, ranks, true));
    if (kz_dynamics_count(b->dynamics) == known) return KZ_OK;
  }
}

static kz_status allocate(basin *b, bool leads) {
  b->work = malloc(sizeof *b->work);
  b->reached = calloc(INT16_MAX + 1, sizeof *b->reached);
  b->label = leads ? calloc((size_t)b->own, sizeof *b->label) : NULL;
  b->periods = leads ? calloc((size_t)b->own, sizeof *b->periods) : NULL;
  b->evidence = leads ? calloc((size_t)b->own, sizeof *b->evidence) : NULL;
  if (b->work && b->reached && (!leads || (b->label && b->periods && b->evidence))) return KZ_OK;
  return kz_fail(KZ_FAILED, "no memory for %lld cells", (long long)b->own);
}

/* From numbers of own cells to ids of all cells. */
static kz_status finish(basin *b, kz_catalogue *catalogue, kz_labels *labels) {
  KZ_TRY(kz_labels_allocate(b->total, labels));
  for (int64_t f = 0; f < b->own; f++) b->reached[b->label[f]]++;
  kz_status status = kz_catalogue_make(b->dynamics, b->reached, catalogue);
  for (int64_t f = 0; status == KZ_OK && f < b->total; f++) {
    bool mirrored = f >= b->own;
    int64_t own = mirrored ? b->total - 1 - f : f;
    int32_t id = b->label[own] > 0 ? catalogue->id_of[b->label[own]] : -1;
    labels->attractor[f] = (int16_t)(mirrored && id >= 0 ? catalogue->entries[id].mirror : id);
    labels->settling_time[f] = b->periods[own];
    labels->evidence[f] = id < 0 ? UNSETTLED : b->periods[own] == 0 ? INSIDE : b->evidence[own];
    labels->undecided += labels->evidence[f] == UNDECIDED;
  }
  return status;
}

/* The errors of the numerics behind the labels, and warnings about them. */
static void measure_numerics(const kz_scene *scene, const basin *b, kz_labels *labels, FILE *summary) {
  labels->step_error = kz_basin_warn_steps(scene, summary);
  labels->table_error = NAN;
  if (scene->basin.method == KZ_METHOD_DIRECT) return;
  labels->table_error = kz_dynamics_table_defect(b->dynamics, kz_stencil(scene->basin.interpolation));
  kz_steps_warn_table(&scene->basin, labels->table_error, summary);
}

static kz_status run_damped(const kz_scene *scene, kz_ranks *ranks, kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = &scene->basin;
  basin b = {.plan = plan,
             .search = {.window = kz_window_of(&plan->theta, &plan->velocity),
                        .starts = plan->starts,
                        .seed = plan->seed,
                        .max_periods = plan->max_periods,
                        .cells = plan->theta.count * plan->velocity.count,
                        .table_theta = plan->method == KZ_METHOD_DIRECT ? 0 : plan->table_theta,
                        .table_velocity = plan->table_velocity},
             .total = plan->theta.count * plan->velocity.count};
  b.own = kz_own_cells(plan);
  b.tile = kz_tile_cells(scene, CELLS);
  b.dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, plan->max_period);
  kz_status status = b.dynamics ? allocate(&b, kz_ranks_own(ranks) == 0) : kz_fail(KZ_FAILED, "no memory for the dynamics");
  status = kz_ranks_agree(ranks, status);
  if (status == KZ_OK) {
    b.search.max_velocity = kz_dynamics_max_velocity(b.dynamics, &b.search.window);
    status = model(&b, ranks);
  }
  kz_doubt doubt = {0};
  if (status == KZ_OK) status = kz_doubt_measure(plan, ranks, b.dynamics, b.label, &doubt);
  if (status == KZ_OK && kz_ranks_own(ranks) == 0) {
    kz_catalogue catalogue = {0};
    kz_labels labels = {.trapped_share = kz_dynamics_trapped_share(b.dynamics), .doubt = doubt};
    measure_numerics(scene, &b, &labels, summary);
    status = finish(&b, &catalogue, &labels);
    if (status == KZ_OK) status = kz_basin_write(scene, &catalogue, &labels, store, summary);
    kz_catalogue_free(&catalogue);
    kz_labels_free(&labels);
  }
  if (b.dynamics) kz_dynamics_free(b.dynamics);
  free(b.work);
  free(b.label);
  free(b.periods);
  free(b.evidence);
  free(b.open);
  free(b.reached);
  return kz_ranks_agree(ranks, status);
}

/* Without damping areas are conserved and nothing attracts. */
static kz_status run_undamped(const kz_scene *scene, kz_ranks *ranks, kz_store *store, FILE *summary) {
  kz_status status = KZ_OK;
  if (kz_ranks_own(ranks) == 0) {
    kz_catalogue catalogue = {0};
    kz_labels labels = {.step_error = NAN, .table_error = NAN};
    int64_t total = scene->basin.theta.count * scene->basin.velocity.count;
    status = kz_labels_allocate(total, &labels);
    for (int64_t f = 0; status == KZ_OK && f < total; f++) {
      labels.attractor[f] = -1;
      labels.settling_time[f] = (uint32_t)scene->basin.max_periods;
    }
    if (status == KZ_OK) {
      fprintf(summary, "basin: without damping nothing attracts: every cell is labelled -1\n");
      status = kz_basin_write(scene, &catalogue, &labels, store, summary);
    }
    kz_labels_free(&labels);
  }
  return kz_ranks_agree(ranks, status);
}

/* With basin.accuracy: the scene with what the program chose. */
static kz_status run_accurate(const kz_scene *scene, kz_ranks *ranks, kz_store *store, FILE *summary) {
  kz_choice choice;
  kz_scene chosen = *scene;
  KZ_TRY(kz_accuracy_choose(scene, ranks, store, summary, &choice));
  kz_config_apply(choice.config, &chosen);
  KZ_TRY(run_damped(&chosen, ranks, store, summary));
  return kz_ranks_agree(ranks, store ? kz_accuracy_write(&choice, scene->basin.accuracy, store) : KZ_OK);
}

kz_status kz_basin_run(const kz_scene *scene, kz_ranks *ranks, kz_store *store, FILE *summary) {
  if (scene->parameters.pendulum.beta <= 0) return run_undamped(scene, ranks, store, summary);
  return (isnan(scene->basin.accuracy) ? run_damped : run_accurate)(scene, ranks, store, summary);
}

bool kz_basin_wanted(const kz_scene *scene) {
  return scene->has_basin;
}

kz_cost kz_basin_cost(const kz_scene *scene) {
  const kz_basin_plan *plan = &scene->basin;
  double cells = (double)plan->theta.count * (double)plan->velocity.count;
  double nodes = plan->method == KZ_METHOD_DIRECT ? 0 : (double)plan->table_theta * (double)plan->table_velocity;
  double regions = pow((double)kz_regions_cells(plan->theta.count * plan->velocity.count), 2);
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  static const double kick_seconds[] = {[KZ_SINGLE] = 4e-10, [KZ_DOUBLE] = 8e-10, [KZ_QUAD] = 2e-6};
  double kicks = (double)scheme.kicks * scene->numerics.steps_per_period;
  double period = kicks * kick_seconds[scene->numerics.precision];
  double table_period = kicks * kick_seconds[scene->numerics.precision == KZ_SINGLE ? KZ_SINGLE : KZ_DOUBLE];
  static const double integrated[] = {[KZ_METHOD_ICM] = 0, [KZ_METHOD_DIRECT] = 1};
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  const double periods = kz_settling_cells(pendulum->beta, plan->max_periods);
  double cell_period = integrated[plan->method] * period + (plan->method == KZ_METHOD_DIRECT ? 0 : 7e-8);
  kz_cost cost = {.cells = plan->theta.count * plan->velocity.count,
                  .disk_bytes = 14 * cells,
                  .memory_bytes = 100 * nodes + 250 * regions,
                  .first_bytes = 27 * cells,
                  .core_seconds = kz_settling_search(pendulum, (double)plan->starts, table_period, plan->max_periods) +
                                  nodes / 2 * table_period + regions / 2 * (8 * table_period + 1e-6) +
                                  cells * periods * cell_period + (double)kz_doubt_cells(plan) * periods * 4 * period};
  if (!isnan(plan->accuracy)) kz_accuracy_cost(plan->accuracy, &cost);
  return cost;
}
