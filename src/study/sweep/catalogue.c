/* The attractors at each value of a sweep, and the share of the starts or of the cells that each takes. A value may
 * take long: all ranks work on it together, and finished work is kept. */
#include "labelling/catalogue.h"
#include "numerics/cells.h"
#include "cells/scene_search.h"
#include "cells/cell_starts.h"
#include "sweep.h"

/* ---- measure lifetime: how long the motions take that have not settled soon ---- */

/* The lifetime of the motions of the sweep's starts at one value. Collective. */
static kz_status measure_lifetime(const kz_sweep_plan *plan, const kz_run *run, kz_dynamics *dynamics,
                                  int64_t max_periods, kz_lifetime *life) {
  enum { TILE = 256 };
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  const size_t n = (size_t)plan->starts;
  KZ_AUTOFREE double *state = kz_malloc(2 * n * sizeof *state);
  KZ_AUTOFREE kz_label *catalogue_end = kz_malloc(n * sizeof *catalogue_end);
  KZ_AUTOFREE uint32_t *time = kz_malloc(n * sizeof *time);
  const kz_labeller labeller = {.dynamics = dynamics,
                                .max_periods = max_periods,
                                .way = KZ_BY_STATES,
                                .at_strobe = true,
                                .state = state,
                                .run = run,
                                .stage = "sweep lifetimes",
                                .tile = TILE};
  kz_dynamics_starts(&window, plan->seed, plan->starts, state);
  KZ_TRY(kz_label_items(&labeller, 1, plan->starts, NULL, catalogue_end));
  for (size_t i = 0; i < n; i++)
    time[i] = catalogue_end[i].label > 0 ? (uint32_t)catalogue_end[i].periods : KZ_NOT_ENDED;
  *life = kz_lifetime_tail(plan->starts, time, (double)max_periods);
  return KZ_OK;
}

enum {
  CHUNK = 4096, /* cells followed at once */
  ROUNDS = 2    /* largest number of rounds of search among unsettled cells */
};

/* One value at work. */
typedef struct {
  const kz_scene *scene;
  const kz_run *run;
  kz_dynamics *dynamics;
  int64_t n_starts, n_cells; /* starts of the search; cells followed on the grid, 0 = none */
  double *state;             /* [starts or cells][2] */
  int32_t *label;            /* [starts] number of kz_dynamics, 0 = not settled */
  kz_label *cell;            /* [cells] */
  int64_t *hits;             /* [numbers from 1] */
  int64_t max_periods;       /* after which a start counts as not settled; of the cells the basin's own number */
} searching;

static void catalogue_begin(const kz_pendulum *pendulum, double value, searching *s) {
  const kz_scene *scene = s->scene;
  s->n_starts = scene->sweep->starts;
  s->max_periods = kz_settling_periods(pendulum->beta);
  if (kz_sweep_has_grid(scene)) s->n_cells = kz_unique_cells(scene->basin);
  const size_t most = (size_t)kz_larger(s->n_starts, CHUNK);
  s->dynamics = kz_dynamics_create(pendulum, &scene->numerics, scene->sweep->max_period);
  if (s->n_cells > 0) kz_studies_begin(scene, pendulum, &value, s->dynamics);
  s->state = kz_malloc(2 * most * sizeof *s->state);
  s->label = kz_malloc(most * sizeof *s->label);
  s->cell = kz_calloc((size_t)s->n_cells + 1, sizeof *s->cell);
}

static void search_end(searching *s) {
  if (s->dynamics) kz_dynamics_free(s->dynamics);
  free(s->state);
  free(s->label);
  free(s->cell);
  free(s->hits);
}

/* Labels the grid, whatever the basin's method, by states alone. */
static kz_status label_grid(searching *s) {
  const kz_basin_plan *basin = s->scene->basin;
  const kz_search_on catalogue_search = {ROUNDS, s->n_starts, NULL};
  kz_labeller labeller = kz_cell_labeller(basin, s->dynamics);
  labeller.way = KZ_BY_STATES;
  labeller.stepper = kz_stepper_of(basin->method, basin->interpolation);
  labeller.run = s->run;
  labeller.stage = "sweep cells";
  labeller.tile = kz_tile_cells(s->scene, CHUNK);
  return kz_label_and_search(&labeller, &catalogue_search, s->n_cells, NULL, s->cell);
}

/* Hits of the cells followed and of those that mirror them; without a grid of the starts. */
static int64_t count_hits(const searching *s) {
  kz_attractor row;
  const int64_t total = s->scene->basin->theta.count * s->scene->basin->velocity.count;
  for (int64_t i = 0; s->n_cells == 0 && i < s->n_starts; i++) s->hits[s->label[i]]++;
  if (s->n_cells == 0) return s->n_starts;
  for (int64_t i = 0; i < s->n_cells; i++) {
    const int16_t label = s->cell[i].label;
    s->hits[label]++;
    if (total - 1 - i < s->n_cells || label == 0) continue;
    kz_dynamics_attractor(s->dynamics, label, &row);
    s->hits[row.mirror]++;
  }
  return total;
}

/* The attractors that something ended on, and their mirror images, in the order of the file. */
static kz_status catalogue_collect(const searching *s, kz_sweep_catalogue *catalogue) {
  const int64_t known = kz_dynamics_count(s->dynamics);
  KZ_AUTOFREE int64_t *order = kz_malloc((size_t)(known + 1) * sizeof *order);
  kz_dynamics_order(s->dynamics, order);
  for (int64_t i = 0; i < known; i++) {
    kz_sweep_entry entry = {.hits = s->hits[order[i]], .number = {NAN, NAN, NAN}};
    kz_dynamics_attractor(s->dynamics, order[i], &entry.point);
    if (entry.hits + s->hits[entry.point.mirror] == 0) continue;
    if (catalogue->count == KZ_SWEEP_MOST)
      return kz_fail(KZ_REFUSED, "sweep: more than %d attractors at one value; use more damping or a smaller window",
                     KZ_SWEEP_MOST);
    catalogue->entries[catalogue->count++] = entry;
  }
  return KZ_OK;
}

/* Finds the attractors in the window of the grid, or, without a grid, in the sweep's own. */
static kz_status sweep_catalogue_discover(searching *s) {
  const kz_sweep_plan *sweep = s->scene->sweep;
  kz_search search = {.window = kz_window_of(&sweep->theta, &sweep->velocity)};
  if (s->n_cells > 0) search = kz_search_of_basin(s->scene->basin);
  search.starts = s->n_starts;
  search.seed = sweep->seed;
  search.max_periods = s->max_periods;
  return kz_search_window(s->run, s->dynamics, &search, s->label);
}

static kz_status search_attractors(searching *s, const kz_pendulum *pendulum, kz_sweep_catalogue *catalogue) {
  const kz_sweep_plan *plan = s->scene->sweep;
  KZ_TRY(sweep_catalogue_discover(s));
  if (s->n_cells > 0) KZ_TRY(label_grid(s));
  s->hits = kz_calloc((size_t)kz_dynamics_count(s->dynamics) + 1, sizeof *s->hits);
  catalogue->samples = count_hits(s);
  catalogue->unsettled = s->hits[0];
  KZ_TRY(kz_ranks_agree(s->run->ranks, catalogue_collect(s, catalogue)));
  if (kz_sweep_measures(plan, KZ_SWEEP_LIFETIME))
    KZ_TRY(measure_lifetime(plan, s->run, s->dynamics, s->max_periods, &catalogue->lifetime));
  const kz_axis *velocity = s->n_cells > 0 ? &s->scene->basin->velocity : &plan->velocity;
  const kz_sweep_value_at at = {s->run, s->dynamics, *pendulum, s->hits, velocity, s->n_cells, s->max_periods};
  const kz_sweep_part *part;
  for (int i = 0; (part = kz_sweep_part_next(plan, true, &i)); i++) KZ_TRY(part->value(s->scene, &at, catalogue));
  return KZ_OK;
}

typedef struct {
  const kz_scene *scene;
  const kz_run *run;
} sweeping;

static kz_status sweep_catalogue_tile(void *context, int64_t tile, void *record) {
  const sweeping *sweep = context;
  const kz_scene *scene = sweep->scene;
  KZ_AUTOFREE_BY(search_end) searching s = {.scene = scene, .run = sweep->run};
  kz_pendulum pendulum;
  const double value = kz_sweep_value(scene->sweep, tile);
  if (!kz_sweep_pendulum(scene, value, &pendulum) || pendulum.beta <= 0) return KZ_OK;
  catalogue_begin(&pendulum, value, &s);
  return search_attractors(&s, &pendulum, record);
}

kz_status kz_sweep_catalogues(const kz_scene *scene, const kz_run *run, kz_sweep_catalogue *catalogue) {
  sweeping sweep = {scene, run};
  kz_stage stage =
      kz_stage_for_all("sweep attractors", scene->sweep->values.count, sizeof *catalogue, sweep_catalogue_tile, &sweep);
  stage.collective = true;
  return kz_stage_run(run, &stage, catalogue);
}
