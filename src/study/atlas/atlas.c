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
  KZ_FREED_BY(kz_atlas_raster_free) kz_atlas_raster raster = {0};
  if (store || scene->atlas->shares > 0) kz_atlas_raster_make(&atlas, &raster);
  if (scene->atlas->shares > 0) {
    const double more = (double)KZ_ATLAS_REGIONS / (double)raster.n_regions; /* a sampled run knows few regions */
    KZ_TRY_WEIGHED(run, more, kz_atlas_shares(&atlas, run, &raster));
  }
  return kz_ranks_agree(run->ranks, store ? kz_atlas_write(&atlas, &raster, store, summary) : KZ_OK);
}

/* As counted: points of all curves in Blackburn's and Butikov's planes, about 500 times this power of the longest period; bytes of a point in the
 * file and in memory. */
static const double POINTS = 500, POWER = 1.8, BYTES = 120;

kz_cost kz_atlas_cost(const kz_scene *scene) {
  const double points = POINTS * pow((double)scene->atlas->max_period, POWER),
               cells = (double)(scene->atlas->points * scene->atlas->points);
  return (kz_cost){.disk_bytes = points * BYTES + 0.3 * cells, .rank0_bytes = 4 * points * BYTES + 60 * cells};
}
