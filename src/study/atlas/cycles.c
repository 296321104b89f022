/* Cycles and points of curves in one canonical form, and the classes of attractors. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cycles.h"

/* rad: two states nearer than this are one; a cycle this near to rest is rest. */
static const double ONE = 1e-5, AT_REST = 1e-9;

kz_atlas_class kz_atlas_class_of(const kz_cycle_kind *kind) {
  if (kind->rest >= 0) return (kz_atlas_class){KZ_CLASS_REST, 1, kind->rest};
  return (kz_atlas_class){kind->of.side > 0 ? KZ_CLASS_OTHER : KZ_CLASS_SYMMETRIC, kz_kind_period(kind),
                          kind->of.turns};
}

kz_atlas_class kz_atlas_class_with(const kz_atlas *atlas, bool symmetric, int32_t period, int32_t turns,
                                   int32_t centre) {
  if (!symmetric) return (kz_atlas_class){KZ_CLASS_OTHER, period, turns};
  const int32_t type = period == 1 && atlas->plane.mirrored ? KZ_CLASS_REST : KZ_CLASS_SYMMETRIC;
  return (kz_atlas_class){type, period, centre == KZ_ABOUT_INVERTED};
}

bool kz_atlas_is_of(const kz_cycle_kind *kind, const kz_atlas_class *class) {
  const kz_atlas_class own = kz_atlas_class_of(kind);
  return !memcmp(&own, class, sizeof own);
}

int32_t kz_atlas_images(const kz_atlas *atlas, const kz_atlas_class *class) {
  return class->type == KZ_CLASS_OTHER && kz_atlas_paired(atlas) ? 2 : 1;
}

int32_t kz_atlas_class_number(kz_atlas *atlas, const kz_atlas_class *class) {
  for (int32_t i = 0; i < atlas->n_classes; i++)
    if (!memcmp(atlas->class + i, class, sizeof *class)) return i;
  if (atlas->n_classes == KZ_ATLAS_MOST_CLASSES) return KZ_ATLAS_MOST_CLASSES - 1;
  atlas->class[atlas->n_classes] = *class;
  return atlas->n_classes++;
}

int32_t kz_atlas_class_centre(const kz_atlas_class *class) {
  if (class->type != KZ_CLASS_OTHER) return class->turns ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN;
  return class->turns ? KZ_ROTATING : KZ_ABOUT_NEITHER;
}

void kz_atlas_class_name(const kz_atlas *atlas, const kz_atlas_class *class, char *text) {
  if (class->type != KZ_CLASS_OTHER)
    kz_orbit_name(class->period, 0, class->turns ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN, text);
  else if (class->turns == 0)
    snprintf(text, KZ_NAME_LENGTH, kz_atlas_paired(atlas) ? "asymmetric %d-nodding" : "%d-nodding", (int)class->period);
  else
    snprintf(text, KZ_NAME_LENGTH, kz_atlas_paired(atlas) ? "rotation %d/%d" : "rotation %+d/%d", (int)class->turns,
             (int)class->period);
}

kz_motion_kind kz_atlas_described(const kz_atlas *atlas, const kz_atlas_class *class) {
  kz_motion_kind kind = {.period = class->period,
                         .winding = class->type == KZ_CLASS_OTHER ? class->turns : 0,
                         .centre = kz_atlas_class_centre(class),
                         .symmetric = class->type != KZ_CLASS_OTHER,
                         .images = kz_atlas_images(atlas, class)};
  kz_atlas_class_name(atlas, class, kind.name);
  return kind;
}

bool kz_atlas_image_state(const kz_atlas *atlas, const double place[2], const double *state, double image[2]) {
  double later[4] = {state[0], state[1], state[0], state[1]};
  if (!kz_atlas_paired(atlas) || (atlas->plane.half_period && !kz_curve_orbit(&atlas->plane, place, 1, 1, later)))
    return false;
  image[0] = -later[2], image[1] = -later[3];
  return true;
}

int kz_atlas_points(const kz_atlas *atlas, const kz_cycle_kind *kind, const double place[2], const double *y,
                    double *point) {
  const int n = kind->of.points, period = kz_kind_period(kind);
  memcpy(point, y, 2 * (size_t)n * sizeof *point);
  for (int i = n; i < period; i++)
    if (!kz_atlas_image_state(atlas, place, y + 2 * (i - n), point + 2 * i)) return 0;
  return period;
}

/* The points that a symmetric cycle leaves out are images of others. */
bool kz_atlas_same(const kz_plane_cycle *cycle, const double *state, const double *image, double near) {
  for (int i = 0; i < cycle->kind.of.points; i++)
    if (kz_atlas_apart(cycle->y + 2 * i, state, 1) < near ||
        (image && kz_atlas_apart(cycle->y + 2 * i, image, 1) < near))
      return true;
  return false;
}

/* Whether the points of a cycle repeat themselves after a shift, as they are or mirrored. */
static bool cycles_repeats(const kz_cycle_kind *kind, const double *y, int shift, double side, double near) {
  const int n = kind->of.points;
  for (int i = 0; i < n; i++)
    if (kz_atlas_apart(y + 2 * i, y + 2 * ((i + shift) % n), i + shift < n ? side : side * kind->of.side) >= near)
      return false;
  return true;
}

/* Whether a point of a curve is one of a curve of the shorter cycle `of`, whose points are the first of y. An even
 * power of a map has no multiplier -1 but where that one's square is, and its multiplier 1 may be that one's -1. Beside
 * the place where a doubled cycle is born both lie as near as one likes, and only the multiplier of the shorter one
 * distinguishes them. */
static bool is_on_its_curve(const kz_atlas *atlas, int power, kz_curve_kind *of, double *y) {
  if (of->multiplier == 0) return true;
  if (of->multiplier < 0 && power % 2 == 0) return false;
  if (kz_curve_is_on(&atlas->plane, of, y)) return true;
  of->multiplier = -1;
  return power % 2 == 0 && kz_curve_is_on(&atlas->plane, of, y);
}

/* Rest has its own kinds: on the map, multiplier -1; on the half map, multiplier -1, which is 1 of the map. */
static kz_cycle_kind rest_of(const kz_cycle_kind *kind, const double *y) {
  kz_cycle_kind rest = {kind->of, cos(y[0]) > 0 ? 0 : 1};
  if (kind->of.multiplier > 0) rest.of.side = -kind->of.side, rest.of.multiplier = -1;
  rest.of.turns = rest.of.side > 0 ? 0 : rest.rest;
  return rest;
}

/* Whether a point beside rest belongs to rest's own curve with that multiplier: Newton's method ends beside it. */
static bool is_rest(const kz_atlas *atlas, double near, const kz_cycle_kind *kind, const double *y) {
  if (!atlas->plane.mirrored || kind->of.points != 1) return false;
  if (kind->rest >= 0) return kind->of.multiplier > 0; /* on the other map */
  if (hypot(sin(y[0]), y[1]) < AT_REST) return true;
  kz_cycle_kind rest = rest_of(kind, y);
  double point[4] = {M_PI * rest.rest, 0, y[2], y[3]};
  return kind->of.multiplier != 0 && hypot(sin(y[0]), y[1]) < near && is_on_its_curve(atlas, 1, &rest.of, point) &&
         rest.of.multiplier < 0;
}

/* Images run half a period later: the image of a cycle's first point is the point (q + 1) / 2 further if the cycle is
 * its own image and has the odd period q. */
static bool reduce_to_image(const kz_atlas *atlas, double near, kz_cycle_kind *kind, double *y) {
  const int n = kind->of.points, period = kz_kind_period(kind);
  for (int q = 1; q <= period && atlas->plane.half_period; q += 2) {
    const int points = (q + 1) / 2, power = kind->of.side < 0 ? period / q : 2;
    double image[2], point[KZ_ATLAS_UNKNOWNS];
    if (period % q != 0 || (kind->of.side < 0 ? q == period : q < period || kind->of.turns != 0)) continue;
    if (!kz_atlas_image_state(atlas, y + 2 * n, y, image) || kz_atlas_apart(image, y + 2 * (points % n), 1) >= near)
      continue;
    memcpy(point, y, 2 * (size_t)points * sizeof *point);
    memcpy(point + 2 * points, y + 2 * n, 2 * sizeof *point);
    kz_curve_kind of = kz_kind_of(&atlas->plane, -1, points, 0, kind->of.multiplier, point);
    if (of.points == 0 || !is_on_its_curve(atlas, power, &of, point)) continue;
    memcpy(y, point, (2 * (size_t)points + 2) * sizeof *y);
    kind->of = of;
    return true;
  }
  return false;
}

bool kz_atlas_reduce(const kz_atlas *atlas, double near, kz_cycle_kind *kind, double *y) {
  const int n = kind->of.points;
  if (is_rest(atlas, near, kind, y)) {
    *kind = rest_of(kind, y);
    y[0] = M_PI * kind->rest, y[1] = 0;
    return true;
  }
  for (int shift = 1; shift < n && kind->rest < 0; shift++)
    for (int side = 1; side >= -1 && n % shift == 0; side -= 2) {
      kz_curve_kind of = {side, shift, kind->of.multiplier, kind->of.turns * shift / n, 0};
      double point[KZ_ATLAS_UNKNOWNS];
      /* Half of a cycle is mirrored, or each odd part of one that is symmetric */
      const bool mirrored = kind->of.side < 0 ? n / shift % 2 == 1 : kind->of.turns == 0 && 2 * shift == n;
      if (side < 0 ? !atlas->plane.mirrored || !mirrored : kind->of.side < 0) continue;
      if (!cycles_repeats(kind, y, shift, side, near)) continue;
      if (side < 0) of.turns = (int32_t)rint((y[2 * shift] + y[0]) / (2 * M_PI));
      memcpy(point, y, 2 * (size_t)shift * sizeof *point);
      memcpy(point + 2 * shift, y + 2 * n, 2 * sizeof *point);
      if (!is_on_its_curve(atlas, n / shift, &of, point)) continue;
      memcpy(y, point, (2 * (size_t)shift + 2) * sizeof *y);
      kind->of = of;
      return true;
    }
  return reduce_to_image(atlas, near, kind, y);
}

/* Angles from a point in [-pi, pi), of images that with positive turns, symmetric cycles about down or inverted. */
static bool cycles_canonical(const kz_atlas *atlas, kz_cycle_kind *kind, double *y) {
  const int n = 2 * kind->of.points;
  double lift = 2 * M_PI * floor(y[0] / (2 * M_PI) + 0.5);
  if (kind->of.side < 0) {
    const int32_t pairs = (kind->of.turns - (kind->of.turns & 1)) / 2;
    lift = 2 * M_PI * pairs;
    kind->of.turns -= 2 * pairs;
  } else if (kind->of.turns < 0 && kz_atlas_paired(atlas)) {
    kind->of.turns = -kind->of.turns;
    for (int i = 0; i < n; i += 2)
      if (!kz_atlas_image_state(atlas, y + n, y + i, y + i)) return false;
    lift = 2 * M_PI * floor(y[0] / (2 * M_PI) + 0.5);
  }
  for (int i = 0; i < n; i += 2) y[i] -= lift;
  return true;
}

bool kz_atlas_add(const kz_atlas *atlas, kz_cycle_kind kind, const double *y, kz_atlas_seeds *seeds) {
  const int n = 2 * kind.of.points;
  kz_plane_cycle seed = {.kind = kind};
  for (int i = 0; i < n + 2; i++) {
    if (!isfinite(y[i])) return false;
    seed.y[i] = y[i];
  }
  for (int i = 0; i < 2; i++)
    if (y[n + i] < atlas->plane.low[i] || y[n + i] > atlas->plane.high[i]) return false;
  while (kz_atlas_reduce(atlas, ONE, &seed.kind, seed.y)) continue;
  if (kz_kind_period(&seed.kind) > atlas->scene->atlas->max_period) return false;
  if (!cycles_canonical(atlas, &seed.kind, seed.y)) return false;
  kz_atlas_put(seeds, &seed);
  return true;
}

void kz_atlas_put(kz_atlas_seeds *seeds, const kz_plane_cycle *seed) {
  seeds->list = kz_list_reserve(seeds->list, &seeds->capacity, seeds->count + 1, sizeof *seeds->list);
  seeds->list[seeds->count++] = *seed;
}

void kz_atlas_seeds_free(kz_atlas_seeds *seeds) {
  free(seeds->list);
  *seeds = (kz_atlas_seeds){0};
}
