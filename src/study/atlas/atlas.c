/* Study `atlas`: motions of up to max_period periods over a plane of two keys. */
#include "cycles.h"
#include "growth.h"
#include "probe.h"
#include "regions.h"

#include "labelling/search.h"
#include "numerics/steps.h"

/* ---- the share of the starts that each class of attractors takes, at one point of each region ---- */

/* Velocities of the starts, rad per drive radian; steps a period of them. */
static const double FASTEST = 2;
enum { STEPS = 24 };

typedef struct {
  const kz_atlas *atlas;
  const kz_atlas_raster *raster;
} counting;

/* The place of an attractor's class among n that the lists have; n = it is none of them. */
static int64_t place_of(const kz_atlas *atlas, const kz_attractor *row, int64_t n) {
  const int32_t turns = kz_atlas_paired(atlas) ? abs(row->winding) : row->winding;
  const kz_atlas_class class =
      kz_atlas_class_with(row->symmetric && kz_atlas_paired(atlas), row->period, turns, row->centre);
  int64_t place = 0;
  while (place < n && memcmp(atlas->class + place, &class, sizeof class)) place++;
  return place;
}

/* Record: starts that end on the attractors of each class, and behind them on none of up to max_periods periods. */
static kz_status share_tile(void *context, int64_t tile, void *record) {
  const counting *c = context;
  const kz_scene *scene = c->atlas->scene;
  const int64_t starts = scene->atlas->shares;
  kz_pendulum pendulum;
  double place[2];
  kz_atlas_region_place(c->raster, tile, place);
  KZ_AUTOFREE_BY(kz_dynamics_freed) kz_dynamics *dynamics = kz_atlas_dynamics(c->atlas, place, STEPS, &pendulum);
  if (!dynamics) return KZ_OK;
  const kz_search search = {.window = {-M_PI, M_PI, -FASTEST, FASTEST},
                            .starts = starts,
                            .seed = 1,
                            .max_periods = kz_settling_periods(pendulum.beta)};
  KZ_AUTOFREE int32_t *label = kz_calloc((size_t)starts, sizeof *label);
  KZ_TRY(kz_search_window(NULL, dynamics, &search, label));
  for (int64_t i = 0; i < starts; i++) {
    kz_attractor row = {.period = 0};
    if (label[i] > 0) kz_dynamics_attractor(dynamics, label[i], &row);
    ((int64_t *)record)[place_of(c->atlas, &row, c->raster->n_classes)]++;
  }
  return KZ_OK;
}

/* Counts where the starts end at the place of each region. Collective. */
static kz_status count_shares(const kz_atlas *atlas, const kz_run *run, kz_atlas_raster *raster) {
  counting c = {atlas, raster};
  const int64_t n = raster->n_regions, classes = raster->n_classes;
  const size_t bytes = (size_t)(classes + 1) * sizeof(int64_t);
  KZ_AUTOFREE int64_t *found = kz_calloc((size_t)n + 1, bytes);
  const kz_stage stage = kz_stage_for_all("atlas shares", n, bytes, share_tile, &c);
  KZ_TRY(kz_stage_run(run, &stage, found));
  raster->hits = kz_calloc((size_t)(n * classes) + 1, sizeof *raster->hits);
  raster->other = kz_calloc((size_t)n + 1, sizeof *raster->other);
  for (int64_t region = 0; region < n; region++) {
    memcpy(raster->hits + region * classes, found + region * (classes + 1), bytes - sizeof(int64_t));
    raster->other[region] = found[region * (classes + 1) + classes];
  }
  return KZ_OK;
}

kz_status kz_atlas_check(const kz_scene *scene) {
  KZ_AUTOFREE_BY(kz_atlas_end) kz_atlas atlas = {0};
  return kz_atlas_begin(scene, &atlas);
}

kz_status kz_atlas_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(kz_atlas_end) kz_atlas atlas = {0};
  KZ_TRY(kz_atlas_begin(scene, &atlas));
  KZ_TRY(kz_atlas_search(&atlas, run));
  KZ_AUTOFREE_BY(kz_atlas_raster_free) kz_atlas_raster raster = {0};
  if (store || scene->atlas->shares > 0) kz_atlas_raster_make(&atlas, &raster);
  if (scene->atlas->shares > 0) KZ_TRY(count_shares(&atlas, run, &raster));
  return kz_ranks_agree(run->ranks, store ? kz_atlas_write(&atlas, &raster, store, summary) : KZ_OK);
}

/* As counted: points of all curves in Blackburn's and Butikov's planes, about 500 times this power of the longest
 * period; bytes of a point in the file and in memory. */
static const double POINTS = 500, POWER = 1.8, BYTES = 120;

kz_cost kz_atlas_cost(const kz_scene *scene) {
  const double points = POINTS * pow((double)scene->atlas->max_period, POWER),
               cells = (double)(scene->atlas->points * scene->atlas->points);
  return (kz_cost){.disk_bytes = points * BYTES + 0.3 * cells, .rank0_bytes = 4 * points * BYTES + 60 * cells};
}
