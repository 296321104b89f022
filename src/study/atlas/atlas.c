/* Study `atlas`: every motion of up to max_period periods over a plane of two keys. */
#include "atlas.h"

#include <math.h>

kz_status kz_atlas_check(const kz_scene *scene) {
  KZ_FREED_BY(kz_atlas_end) kz_atlas atlas = {0};
  return kz_atlas_begin(scene, &atlas);
}

kz_status kz_atlas_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_FREED_BY(kz_atlas_end) kz_atlas atlas = {0};
  KZ_TRY(kz_atlas_begin(scene, &atlas));
  KZ_TRY(kz_atlas_search(&atlas, run));
  kz_status status = KZ_OK;
  if (store) {
    KZ_FREED_BY(kz_atlas_raster_free) kz_atlas_raster raster = {0};
    kz_atlas_order(&atlas);
    kz_atlas_raster_make(&atlas, &raster);
    status = kz_atlas_write(&atlas, &raster, store, summary);
  }
  return kz_ranks_agree(run->ranks, status);
}

/* As counted: points of all curves and points of branches in Blackburn's and Butikov's planes, about 500 and 1500 times this power of the
 * longest period; bytes of a point in the file and in memory. */
static const double POINTS = 500, BRANCHES = 1500, POWER = 1.8, BYTES = 120;

kz_cost kz_atlas_cost(const kz_scene *scene) {
  const double points = POINTS * pow((double)scene->atlas.max_period, POWER),
               cells = (double)(scene->atlas.points * scene->atlas.points);
  return (kz_cost){.disk_bytes = points * BYTES + 0.3 * cells, .rank0_bytes = 4 * points * BYTES + 60 * cells};
}

/* Points of a branch are timed, and the search of a few places: 144 are searched first, and twice as many starts at those of six rounds. */
kz_status kz_atlas_measure(const kz_scene *scene, double *seconds) {
  enum { PLACES = 4, STARTS = 128 };
  KZ_FREED_BY(kz_atlas_end) kz_atlas atlas = {0};
  KZ_TRY(kz_atlas_begin(scene, &atlas));
  const double growth = pow((double)scene->atlas.max_period, POWER), begin = kz_processor_clock();
  for (int i = 0; i < PLACES; i++) {
    const double place[2] = {0.2 + 0.2 * i, 0.35 + 0.15 * i};
    kz_atlas_probe probe;
    KZ_TRY(kz_atlas_probe_at(&atlas, place, STARTS, 1, &probe));
    kz_atlas_seeds_free(&probe.found);
  }
  const double searched = kz_processor_clock() - begin, traced = kz_processor_clock();
  kz_atlas_seed rest = {{{1, 1, 0, 0}, 0}, {0, 0, 0.5, 0.1}};
  double row[20 * 6], event[5];
  const double up[2] = {0, 1};
  int64_t events;
  int32_t ending;
  const int64_t n = kz_curve_branch(&atlas.plane, &rest.kind.of, rest.y, up, 0.02, 20, row, 1, event, &events, &ending);
  const double point = (kz_processor_clock() - traced) / (double)(n + 1);
  *seconds += searched / PLACES * (144 + 12 * (double)scene->atlas.checks) + growth * point * (3 * POINTS + BRANCHES);
  return KZ_OK;
}
