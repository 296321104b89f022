/* One line through an atlas: the branches of all cycles along it, attracting or not. */
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "branch.h"

static void complete_points(const kz_atlas *atlas, kz_atlas_curve *curve) {
  for (int64_t i = 0; i < curve->n; i++) kz_atlas_complete(atlas, &curve->row[i].at);
  kz_atlas_sign(atlas, curve);
}

kz_status kz_atlas_line(kz_atlas *atlas, int axis, double value, kz_atlas_branches *line) {
  kz_atlas_seeds seeds = {0};
  double place;
  *line = (kz_atlas_branches){0};
  KZ_TRY(kz_atlas_place(atlas, 1 - axis, value, &place));
  for (int64_t i = 0; i < atlas->n_curves; i++)
    if (!atlas->curve[i].signature) complete_points(atlas, atlas->curve + i);
  kz_atlas_explore_line(atlas, kz_atlas_axis(atlas, axis), place, 0, &seeds, line);
  kz_atlas_seeds_free(&seeds);
  return KZ_OK;
}
