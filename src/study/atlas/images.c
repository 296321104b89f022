/* A plane with k and -k: each curve has an image there, which shows whether one is missing. */
#include <math.h>
#include <string.h>

#include "lines.h"
#include "cycles.h"
#include "seeds.h"

enum { LINES = 80 };
/* Sides of the plane: partners lie so near to each other; crossings nearer than this to an edge are left out. */
static const double NEAR = 1e-3, EDGE = 1e-6;

/* The kind of the image at -k. */
static kz_cycle_kind image_of(const kz_cycle_kind *kind) {
  kz_cycle_kind image = *kind;
  if (kind->rest >= 0) image.rest = 1 - kind->rest;
  if (kind->of.side < 0) image.of.turns = 1 - kind->of.turns;
  return image;
}

/* The point of a curve that Newton's method finds along an axis from the cycle `from` at a place becomes a seed. */
static void add_beside(const kz_atlas *atlas, const kz_cycle_kind *kind, const double *from, const double place[2],
                       kz_atlas_seeds *seeds) {
  const int n = 2 * kind->of.points;
  for (int axis = 0; axis < 2; axis++) {
    const double along[2] = {axis == 0, axis == 1};
    double y[KZ_ATLAS_UNKNOWNS];
    memcpy(y, from, (size_t)n * sizeof *y);
    memcpy(y + n, place, 2 * sizeof *y);
    if (kz_curve_locate(&atlas->plane, &kind->of, y, along) && kz_atlas_add(atlas, *kind, y, seeds)) return;
  }
}

/* Seeds from each point's own image: an orbit from one point would lose the digits by which the cycle repels. */
void kz_atlas_explore_image(const kz_atlas *atlas, const kz_cycle_kind *kind, const double *at, kz_atlas_seeds *seeds) {
  const int n = kind->of.points;
  const kz_cycle_kind image = image_of(kind);
  const double half_turn = M_PI * (kind->of.side < 0 ? image.of.turns - kind->of.turns : 1);
  double y[KZ_ATLAS_UNKNOWNS], place[2];
  if (!atlas->turned || kind->rest >= 0 || !kz_atlas_image(atlas, at + 2 * n, place)) return;
  for (int i = 0; i < n; i++) {
    double state[4] = {at[2 * i], at[2 * i + 1]};
    if (!kz_curve_orbit(&atlas->plane, at + 2 * n, 1, 1, state)) return;
    y[2 * i] = state[2] + half_turn, y[2 * i + 1] = state[3];
  }
  add_beside(atlas, &image, y, place, seeds);
}

void kz_atlas_explore_mirrored(const kz_atlas *atlas, const kz_cycle_kind *kind, const double *at,
                               kz_atlas_seeds *seeds) {
  const int n = 2 * kind->of.points;
  kz_cycle_kind image = *kind;
  double y[KZ_ATLAS_UNKNOWNS];
  image.of.turns = -kind->of.turns;
  for (int i = 0; i < n; i++) y[i] = -at[i];
  add_beside(atlas, &image, y, at + n, seeds);
}

/* Whether a line has a crossing with a curve of a kind at a value. */
static bool images_has(const kz_atlas *atlas, const kz_atlas_crossings *crossings, const kz_cycle_kind *kind,
                       double at) {
  for (int64_t i = 0; i < crossings->count; i++) {
    const kz_atlas_crossing *other = crossings->list + i;
    if (!memcmp(&atlas->curve[other->curve].kind, kind, sizeof *kind) && fabs(other->at - at) < NEAR) return true;
  }
  return false;
}

/* The crossings of a line at a value of k that the line at -k lacks become seeds. */
static void images_compare(kz_atlas *atlas, int axis, double value, const kz_atlas_crossings *here,
                           const kz_atlas_crossings *there) {
  for (int64_t i = 0; i < here->count; i++) {
    const kz_atlas_crossing *crossing = here->list + i;
    const kz_cycle_kind *kind = &atlas->curve[crossing->curve].kind, image = image_of(kind);
    kz_plane_cycle at;
    if (crossing->at < EDGE || crossing->at > 1 - EDGE) continue;
    atlas->compared++;
    if (images_has(atlas, there, &image, crossing->at)) continue;
    atlas->alone++;
    if (kz_atlas_crossing_point(atlas, 1 - axis, value, crossing, &at))
      kz_atlas_explore_image(atlas, &at.kind, at.y, &atlas->pending);
  }
}

void kz_atlas_compare_images(kz_atlas *atlas) {
  atlas->compared = atlas->alone = 0;
  if (!atlas->turned) return;
  for (int i = 0; i < LINES; i++) {
    KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings here = {0};
    KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings there = {0};
    const double share = (i + 0.5) / LINES, place[2] = {share, share};
    double image[2];
    if (!kz_atlas_image(atlas, place, image) || !memcmp(place, image, sizeof place)) continue;
    const int axis = image[0] != place[0] ? 0 : 1;
    kz_atlas_crossings_of(atlas, axis, place[axis], false, &here);
    kz_atlas_crossings_of(atlas, axis, image[axis], false, &there);
    images_compare(atlas, axis, place[axis], &here, &there);
  }
}
