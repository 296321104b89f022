/* What a basin costs: memory and disk by its counts, time by samples. The attractors are looked for from few starts; with them some cells
 * are labelled, and parts of what comes after are done. */
#include <math.h>
#include <stdlib.h>

#include "accuracy/accuracy.h"
#include "labelling/catalogue.h"
#include "labelling/search.h"
#include "basin.h"
#include "numerics/share.h"

/* s a cell, as measured: its record, its measures, its place in the file. */
static const double WRITE_SECONDS = 1.2e-7;

/* Of FILE and FILE.checkpoint. Measured with Fig. 12's scene on 10^6 to 4 10^8 cells: finer grids have longer runs of equal labels. */
static double packed_bytes(double cells) {
  return 0.9 * pow(cells, 0.96);
}

kz_cost kz_basin_cost(const kz_scene *scene) {
  const kz_basin_plan *plan = &scene->basin;
  const kz_tiles tiles = kz_tiles_of(scene, KZ_TILE_CELLS);
  const int64_t cells = plan->theta.count * plan->velocity.count;
  const double nodes = plan->method == KZ_METHOD_ICM ? (double)plan->table_theta * (double)plan->table_velocity : 0;
  const double regions = pow((double)kz_regions_cells(cells), 2);
  return (kz_cost){.cells = cells,
                   .disk_bytes = 3e5 + 40 * (double)plan->starts + 8.2 * nodes + packed_bytes((double)cells),
                   .memory_bytes = 14 * nodes + 100 * regions + kz_proof_bytes(scene) + kz_phases_bytes(plan) +
                                   40 * (double)kz_tile_capacity(&tiles),
                   .rank0_bytes = 4e6,
                   .shared_bytes = 0.2 * (double)cells};
}

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  kz_window_labels labelling; /* of some cells, by this process alone */
  int64_t *item;              /* [FEW_CELLS] */
  double seconds;
} sample;

enum { FEW_CELLS = 32768, BLOCK = 1024, BATCH = 4096 };

static const kz_run ALONE = {NULL, NULL};

/* The catalogue of the attractors that a few starts end on; regions and table are as the study has them. */
static kz_status basin_cost_discover(sample *s, kz_catalogue *catalogue) {
  int32_t label[KZ_SEARCH_FEW];
  const kz_search search = kz_search_of_basin(&s->scene->basin);
  KZ_TRY(kz_search_measure(s->dynamics, &search, label, &s->seconds));
  kz_dynamics_update(s->dynamics);
  KZ_FREED int64_t *reached = kz_calloc((size_t)kz_dynamics_count(s->dynamics) + 1, sizeof *reached);
  for (int64_t i = 0; i < search.starts && i < KZ_SEARCH_FEW; i++) reached[label[i]]++;
  kz_catalogue_make(s->dynamics, reached, catalogue);
  return KZ_OK;
}

/* Without regard to errors. */
static kz_status measure_followed(sample *s, int64_t n) {
  KZ_FREED kz_label *cell = kz_malloc((size_t)n * sizeof *cell);
  const double start = kz_processor_clock();
  KZ_TRY(kz_label_first(&s->labelling.labeller, n, s->item, cell));
  s->seconds += (kz_processor_clock() - start) / (double)n * (double)kz_unique_cells(&s->scene->basin);
  return KZ_OK;
}

/* One precision level for n cells of `all` that come to it: *n becomes how many it leaves, to the front of s->item. */
static kz_status measure_level(sample *s, int32_t level, int32_t before, double all, int64_t *n, double *share) {
  const kz_labeller *labeller = &s->labelling.labeller;
  static const double enough = 0.3; /* s */
  KZ_FREED kz_label *label = kz_malloc(BATCH * sizeof *label);
  const double before_tables = kz_processor_clock();
  kz_status status = kz_label_at(labeller, level, before, 1, s->item, label); /* makes its tables */
  const double start = kz_processor_clock();
  int64_t done = 0, left = 0, part;
  s->seconds += start - before_tables;
  for (; status == KZ_OK && done < *n && kz_processor_clock() - start < enough; done += part) {
    const int64_t batch = kz_level_rows[level].tile; /* at most BATCH */
    part = *n - done < batch ? *n - done : batch;
    status = kz_label_at(labeller, level, before, part, s->item + done, label);
    for (int64_t i = 0; i < part; i++)
      if (label[i].label == KZ_DOUBTFUL) s->item[left++] = s->item[done + i];
  }
  s->seconds += (kz_processor_clock() - start) / (double)done * all;
  *n = left;
  *share = (double)left / (double)done;
  return status;
}

static kz_status measure_exact(sample *s, int64_t n) {
  const kz_labeller *labeller = &s->labelling.labeller;
  double all = (double)kz_unique_cells(&s->scene->basin), share;
  for (int32_t level = KZ_LEVEL_DOUBLE, before = level; n > 0 && level < KZ_LEVELS;) {
    KZ_TRY(measure_level(s, level, before, all, &n, &share));
    all *= share;
    before = level;
    level = kz_level_after(labeller, level, (int64_t)ceil(all));
  }
  return KZ_OK;
}

/* The reference orbit of a deep window, or its first seconds; *images: NULL where none is needed, or not all of them are made. */
static kz_status measure_reference(sample *s, kz_images **images) {
  static const double enough = 3; /* s */
  const kz_basin_plan *plan = &s->scene->basin;
  *images = NULL;
  if (!kz_plan_is_centred(plan) || plan->method != KZ_METHOD_EXACT) return KZ_OK;
  kz_images *made = kz_images_create(&s->scene->parameters.pendulum, &plan->theta, &plan->velocity);
  kz_status status = KZ_OK;
  double spent = 0, last = 0;
  for (double start = kz_processor_clock(); status == KZ_OK && !made->finished && spent < enough; spent += last) {
    status = kz_images_follow(made, s->dynamics, 1, plan->max_periods);
    last = kz_processor_clock() - start - spent;
  }
  s->seconds += spent + (made->finished ? 0 : last * kz_images_left(made));
  if (status == KZ_OK && made->finished) *images = kz_images_hold(made);
  kz_images_free(made);
  return status;
}

static kz_status measure_cells(sample *s) {
  kz_images *images;
  const kz_basin_plan *plan = &s->scene->basin;
  const int64_t own = kz_unique_cells(plan), n = own < FEW_CELLS ? own : FEW_CELLS;
  const int64_t blocks = own / BLOCK; /* neighbours settle together, as in a run: cells one by one would take longer */
  for (int64_t i = 0; i < n; i++) s->item[i] = n == own ? i : kz_shuffled(i / BLOCK, blocks, plan->seed) * BLOCK + i % BLOCK;
  KZ_TRY(measure_reference(s, &images));
  s->labelling = (kz_window_labels){.plan = plan,
                                    .pendulum = &s->scene->parameters.pendulum,
                                    .dynamics = s->dynamics,
                                    .tiles = kz_tiles_of(s->scene, KZ_TILE_CELLS),
                                    .images = images,
                                    .run = &ALONE,
                                    .tile = kz_tile_cells(s->scene, KZ_TILE_CELLS)};
  kz_window_labels_start(&s->labelling);
  kz_images_free(images);
  s->seconds += WRITE_SECONDS * (double)(plan->theta.count * plan->velocity.count);
  kz_status status = plan->method == KZ_METHOD_EXACT ? measure_exact(s, n) : measure_followed(s, n);
  if (status == KZ_OK && plan->has_boundary) status = kz_pairs_measure(plan, &s->labelling, &s->seconds);
  kz_window_starts_free(&s->labelling.starts);
  KZ_TRY(status);
  return kz_doubt_measure(plan, s->dynamics, &s->seconds);
}

static kz_status measure_parts(sample *s) {
  kz_catalogue catalogue = {0};
  kz_status status = basin_cost_discover(s, &catalogue);
  if (status == KZ_OK) status = measure_cells(s);
  if (status == KZ_OK) status = kz_phases_measure(s->scene, s->dynamics, &s->seconds);
  if (status == KZ_OK) status = kz_shocks_measure(s->scene, s->dynamics, &catalogue, &s->seconds);
  if (status == KZ_OK) status = kz_proof_measure(s->scene, s->dynamics, &s->seconds);
  kz_catalogue_free(&catalogue);
  return status;
}

static kz_status measure_damped(const kz_scene *scene, double *seconds) {
  sample s = {.scene = scene, .item = kz_malloc(FEW_CELLS * sizeof *s.item)};
  s.dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, scene->basin.max_period);
  kz_dynamics_set_release(s.dynamics, &scene->parameters.release);
  const kz_status status = measure_parts(&s);
  kz_dynamics_free(s.dynamics);
  free(s.item);
  *seconds += s.seconds;
  return status;
}

kz_status kz_basin_measure(const kz_scene *scene, double *seconds) {
  if (!(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  if (isnan(scene->basin.accuracy)) return measure_damped(scene, seconds);
  kz_scene chosen = *scene; /* in most cases the setting is method exact, or takes less */
  kz_setting_apply(kz_setting_exact, &chosen);
  KZ_TRY(kz_accuracy_measure(scene, seconds));
  return measure_damped(&chosen, seconds);
}
