/* One line through an atlas: the branches of all cycles along it, attracting or not. */
#include <string.h>

#include "atlas.h"

/* A file has the first point of the cycles only: the others follow from it. */
static void complete(const kz_atlas *atlas, kz_atlas_curve *curve) {
  const int64_t width = kz_atlas_width(&curve->kind);
  const int n = curve->kind.of.points;
  double state[2 * KZ_CURVE_POINTS + 2];
  for (int64_t i = 0; i < curve->n && n > 1; i++) {
    double *row = curve->row + i * width;
    memcpy(state, row + KZ_ROW_POINTS, 2 * sizeof *state);
    if (kz_curve_orbit(&atlas->plane, row, n - 1, state)) memcpy(row + KZ_ROW_POINTS, state, 2 * (size_t)n * sizeof *state);
  }
  kz_atlas_sign(curve);
}

kz_status kz_atlas_line(kz_atlas *atlas, int axis, double value, kz_atlas_branches *line) {
  kz_atlas_seeds seeds = {0};
  double place;
  *line = (kz_atlas_branches){0};
  KZ_TRY(kz_atlas_place(atlas, 1 - axis, value, &place));
  for (int64_t i = 0; i < atlas->n_curves; i++)
    if (!atlas->curve[i].signature) complete(atlas, atlas->curve + i);
  kz_atlas_explore_line(atlas, axis, place, 0, &seeds, line);
  kz_atlas_seeds_free(&seeds);
  return KZ_OK;
}
