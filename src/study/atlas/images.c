/* A plane with k and -k: each curve has an image there, which shows whether one is missing. */
#include "lines.h"
#include "cycles.h"
#include "seeds.h"

enum { LINES = 80 };
/* Sides of the plane: partners lie so near to each other; crossings nearer than this to an edge are left out. */
static const double NEAR = 1e-3, EDGE = 1e-6;

/* The kind of the image at -k. */
static kz_cycle_kind image_of(const kz_cycle_kind *kind) {
  kz_cycle_kind image = *kind;
  if (kind->rest) image.rest = 3 - kind->rest;
  if (kind->side < 0) image.turns = 1 - kind->turns;
  return image;
}

/* The point of a curve that Newton's method finds along an axis from a cycle becomes a seed. */
static void add_beside(const kz_atlas *atlas, const kz_cycle *from, kz_atlas_seeds *seeds) {
  for (int axis = 0; axis < 2; axis++) {
    kz_cycle at = *from;
    if (kz_cycle_locate(&atlas->plane, &at, (double[]){axis == 0, axis == 1}) && kz_atlas_add(atlas, &at, seeds))
      return;
  }
}

/* Each point of the cycle has its own image: an orbit from one of them would lose the digits by which the cycle repels.
 */
void kz_atlas_explore_image(const kz_atlas *atlas, const kz_cycle *at, kz_atlas_seeds *seeds) {
  kz_cycle image = {.kind = image_of(&at->kind)};
  const double half_turn = M_PI * (at->kind.side < 0 ? image.kind.turns - at->kind.turns : 1);
  if (!atlas->turned || at->kind.rest || !kz_atlas_image(atlas, at->place, image.place)) return;
  for (int i = 0; i < at->kind.points; i++) {
    double state[4] = {at->point[i][0], at->point[i][1]};
    if (!kz_curve_orbit(&atlas->plane, at->place, 1, 1, state)) return;
    image.point[i][0] = state[2] + half_turn, image.point[i][1] = state[3];
  }
  add_beside(atlas, &image, seeds);
}

void kz_atlas_explore_mirrored(const kz_atlas *atlas, const kz_cycle *at, kz_atlas_seeds *seeds) {
  kz_cycle image = *at;
  image.kind.turns = -at->kind.turns;
  for (int i = 0; i < at->kind.points; i++)
    for (int c = 0; c < 2; c++) image.point[i][c] = -at->point[i][c];
  add_beside(atlas, &image, seeds);
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
    kz_cycle at;
    if (crossing->at < EDGE || crossing->at > 1 - EDGE) continue;
    atlas->compared++;
    if (images_has(atlas, there, &image, crossing->at)) continue;
    atlas->alone++;
    if (kz_atlas_crossing_point(atlas, 1 - axis, value, crossing, &at))
      kz_atlas_explore_image(atlas, &at, &atlas->pending);
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
