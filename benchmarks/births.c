/* Follows cycles of a place down to the first curve that each meets, and tells which of these curves an atlas lacks.
 *
 *   births ATLAS.h5 X Y < CYCLES
 *
 * CYCLES: a cycle a line: its period, then angle and velocity of each strobe point (rad, rad per drive radian).
 * stdout: for each curve that the atlas lacks and that has a band of attractors of more than 1e-5 sides of the plane
 * where a cycle meets it "lacks PERIOD MULTIPLIER Y BAND", and then "followed CYCLES FOLLOWED MET KNOWN THIN": THIN
 * meetings are with curves of thinner bands. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene/scene.h"
#include "study/atlas/atlas.h"

static const double LEAST_BAND = 1e-5;

static kz_status open_atlas(const char *path, kz_scene *scene, kz_atlas **atlas) {
  kz_store *store;
  KZ_TRY(kz_store_open(path, &store));
  KZ_AUTOFREE char *text = kz_store_text_of(store, "scene_resolved");
  KZ_TRY(kz_scene_read(text, strlen(text), path, 0, NULL, scene));
  KZ_TRY(kz_atlas_open(scene, store, atlas));
  kz_store_discard(store);
  for (int64_t i = 0; i < (*atlas)->n_curves; i++) {
    kz_atlas_curve *curve = (*atlas)->curve + i;
    for (int64_t row = 0; row < curve->n; row++) kz_atlas_complete(*atlas, &curve->row[row].at);
    kz_atlas_sign(*atlas, curve);
  }
  return KZ_OK;
}

/* The next cycle of stdin, as one of a place. */
static bool read_cycle(const kz_atlas *atlas, const double place[2], kz_cycle *cycle, bool *exists) {
  int n;
  if (scanf("%d", &n) != 1 || n < 1 || n > KZ_CURVE_POINTS) return false;
  *cycle = (kz_cycle){.kind = {.side = 1, .points = n}, .place = {place[0], place[1]}};
  for (int i = 0; i < n; i++)
    if (scanf("%lf %lf", cycle->point[i], cycle->point[i] + 1) != 2) return false;
  *exists = kz_atlas_identify(atlas, cycle, INFINITY);
  return true;
}

/* Adds the curve of a seed that the atlas lacks, and tells it. */
static void births_tell(kz_atlas *atlas, const kz_cycle *seed) {
  kz_atlas_curve curve;
  double value[2];
  kz_atlas_trace(atlas, seed, &curve);
  if (curve.n == 0) return kz_atlas_curve_free(&curve);
  if (!kz_atlas_keep(atlas, &curve)) return;
  kz_atlas_values(atlas->scene->atlas, seed->place, value);
  printf("lacks %d %d %.9g %.2e\n", (int)kz_kind_period(&seed->kind), (int)seed->kind.multiplier,
         value[kz_atlas_axis(atlas, 1)], kz_atlas_band_at(atlas, seed));
}

int main(int count, char **word) {
  kz_scene scene = {0};
  kz_atlas *atlas = NULL;
  double place[2];
  int64_t cycles = 0, followed = 0, met = 0, known = 0, thin = 0;
  if (count != 4 || open_atlas(word[1], &scene, &atlas) != KZ_OK) return 2;
  for (int i = 0; i < 2; i++)
    if (kz_atlas_place(atlas, i, strtod(word[2 + i], NULL), place + kz_atlas_axis(atlas, i)) != KZ_OK) return 2;
  kz_cycle cycle;
  for (bool exists; read_cycle(atlas, place, &cycle, &exists); cycles++) {
    KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds births = {0};
    if (!exists) continue;
    followed++;
    kz_atlas_explore_first(atlas, &cycle, &births);
    met += births.count > 0;
    for (int64_t i = 0; i < births.count; i++)
      if (kz_atlas_known(atlas, births.list + i) >= 0)
        known++;
      else if (kz_atlas_band_at(atlas, births.list + i) < LEAST_BAND)
        thin++;
      else
        births_tell(atlas, births.list + i);
  }
  printf("followed %ld %ld %ld %ld %ld\n", (long)cycles, (long)followed, (long)met, (long)known, (long)thin);
  kz_atlas_close(atlas);
  kz_scene_free(&scene);
  return 0;
}
