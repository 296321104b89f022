/* Cycles and points of curves in one canonical form, and the classes of attractors. */
#include "cycles.h"

/* rad: two states nearer than this are one; a cycle this near to rest is rest. */
static const double ONE = 1e-5, AT_REST = 1e-9;

kz_atlas_class kz_atlas_class_of(const kz_cycle_kind *kind) {
  if (kind->rest) return (kz_atlas_class){1, 1, kind->rest - 1};
  return (kz_atlas_class){kind->side < 0, kz_kind_period(kind), kind->turns};
}

kz_atlas_class kz_atlas_class_with(bool symmetric, int32_t period, int32_t turns, int32_t centre) {
  return (kz_atlas_class){symmetric, period, symmetric ? centre == KZ_ABOUT_INVERTED : turns};
}

bool kz_atlas_is_of(const kz_cycle_kind *kind, const kz_atlas_class *class) {
  const kz_atlas_class own = kz_atlas_class_of(kind);
  return !memcmp(&own, class, sizeof own);
}

int32_t kz_atlas_images(const kz_atlas *atlas, const kz_atlas_class *class) {
  return !class->symmetric && kz_atlas_paired(atlas) ? 2 : 1;
}

int32_t kz_atlas_class_number(kz_atlas *atlas, const kz_atlas_class *class) {
  for (int32_t i = 0; i < atlas->n_classes; i++)
    if (!memcmp(atlas->class + i, class, sizeof *class)) return i;
  if (atlas->n_classes == KZ_ATLAS_MOST_CLASSES) return KZ_ATLAS_MOST_CLASSES - 1;
  atlas->class[atlas->n_classes] = *class;
  return atlas->n_classes++;
}

int32_t kz_atlas_class_centre(const kz_atlas_class *class) {
  if (class->symmetric) return class->turns ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN;
  return class->turns ? KZ_ROTATING : KZ_ABOUT_NEITHER;
}

void kz_atlas_class_name(const kz_atlas *atlas, const kz_atlas_class *class, char *text) {
  if (class->symmetric)
    kz_orbit_name(class->period, 0, class->turns ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN, text);
  else if (class->turns == 0)
    snprintf(text, KZ_NAME_LENGTH, kz_atlas_paired(atlas) ? "asymmetric %d-nodding" : "%d-nodding", (int)class->period);
  else
    snprintf(text, KZ_NAME_LENGTH, kz_atlas_paired(atlas) ? "rotation %d/%d" : "rotation %+d/%d", (int)class->turns,
             (int)class->period);
}

kz_motion_kind kz_atlas_described(const kz_atlas *atlas, const kz_atlas_class *class) {
  kz_motion_kind kind = {.period = class->period,
                         .winding = !class->symmetric ? class->turns : 0,
                         .centre = kz_atlas_class_centre(class),
                         .symmetric = class->symmetric,
                         .images = kz_atlas_images(atlas, class)};
  kz_atlas_class_name(atlas, class, kind.name);
  return kind;
}

bool kz_atlas_image_state(const kz_atlas *atlas, const double place[2], const double state[2], double image[2]) {
  double later[4] = {state[0], state[1], state[0], state[1]};
  if (!kz_atlas_paired(atlas) || (atlas->plane.half_period && !kz_curve_orbit(&atlas->plane, place, 1, 1, later)))
    return false;
  image[0] = -later[2], image[1] = -later[3];
  return true;
}

int kz_atlas_points(const kz_atlas *atlas, const kz_cycle *cycle, double (*point)[2]) {
  const int n = cycle->kind.points, period = kz_kind_period(&cycle->kind);
  memcpy(point, cycle->point, (size_t)n * sizeof *point);
  for (int i = n; i < period; i++)
    if (!kz_atlas_image_state(atlas, cycle->place, cycle->point[i - n], point[i])) return 0;
  return period;
}

/* The points that a symmetric cycle leaves out are images of others. */
bool kz_atlas_has(const kz_atlas *atlas, int64_t n, const kz_cycle *list, const kz_cycle *cycle, double near) {
  double image[2];
  const bool has_image = n > 0 && kz_atlas_image_state(atlas, cycle->place, cycle->point[0], image);
  for (int64_t c = 0; c < n; c++)
    for (int i = 0; i < list[c].kind.points && kz_kind_period(&list[c].kind) == kz_kind_period(&cycle->kind); i++)
      if (kz_atlas_apart(list[c].point[i], cycle->point[0], 1) < near ||
          (has_image && kz_atlas_apart(list[c].point[i], image, 1) < near))
        return true;
  return false;
}

/* Whether the points of a cycle repeat themselves after a shift, as they are or mirrored. */
static bool cycles_repeats(const kz_cycle *cycle, int shift, double side, double near) {
  const int n = cycle->kind.points;
  for (int i = 0; i < n; i++)
    if (kz_atlas_apart(cycle->point[i], cycle->point[(i + shift) % n],
                       i + shift < n ? side : side * cycle->kind.side) >= near)
      return false;
  return true;
}

/* Whether a point of a curve is one of a curve of the shorter cycle `of`, whose points are its first. An even power of
 * a map has no multiplier -1 but where that one's square is, and its multiplier 1 may be that one's -1. Beside the
 * place where a doubled cycle is born both lie as near as one likes, and only the multiplier of the shorter one
 * distinguishes them. */
static bool is_on_its_curve(const kz_atlas *atlas, int power, kz_cycle *of) {
  if (of->kind.multiplier == 0) return true;
  if (of->kind.multiplier < 0 && power % 2 == 0) return false;
  if (kz_cycle_is_on(&atlas->plane, of)) return true;
  of->kind.multiplier = -1;
  return power % 2 == 0 && kz_cycle_is_on(&atlas->plane, of);
}

/* Rest has its own kinds: on the map, multiplier -1; on the half map, multiplier -1, which is 1 of the map. */
static kz_cycle rest_of(const kz_cycle *cycle) {
  kz_cycle rest = {.kind = cycle->kind, .place = {cycle->place[0], cycle->place[1]}};
  rest.kind.rest = cos(cycle->point[0][0]) > 0 ? 1 : 2;
  if (rest.kind.multiplier > 0) rest.kind.side = -rest.kind.side, rest.kind.multiplier = -1;
  rest.kind.turns = rest.kind.side > 0 ? 0 : rest.kind.rest - 1;
  rest.point[0][0] = kz_kind_rest(&rest.kind);
  return rest;
}

/* A point of a curve beside rest is one of rest's own curve where rest has that multiplier: Newton's method ends there
 * beside it. */
static bool is_rest(const kz_atlas *atlas, double near, const kz_cycle *cycle) {
  const double away = hypot(sin(cycle->point[0][0]), cycle->point[0][1]);
  if (!atlas->plane.mirrored || cycle->kind.points != 1) return false;
  if (cycle->kind.rest) return cycle->kind.multiplier > 0; /* on the other map */
  if (away < AT_REST) return true;
  kz_cycle rest = rest_of(cycle);
  return cycle->kind.multiplier != 0 && away < near && is_on_its_curve(atlas, 1, &rest) && rest.kind.multiplier < 0;
}

/* The shorter cycle of the first points of a cycle. */
static kz_cycle begin_of(const kz_cycle *cycle, int32_t side, int32_t points, int32_t turns) {
  kz_cycle begin = {.kind = {.side = side, .points = points, .multiplier = cycle->kind.multiplier, .turns = turns},
                    .place = {cycle->place[0], cycle->place[1]}};
  memcpy(begin.point, cycle->point, (size_t)points * sizeof *begin.point);
  return begin;
}

/* Images run half a period later: the image of a cycle's first point is the point (q + 1) / 2 further if the cycle is
 * its own image and has the odd period q. */
static bool reduce_to_image(const kz_atlas *atlas, double near, kz_cycle *cycle) {
  const kz_cycle_kind *kind = &cycle->kind;
  const int n = kind->points, period = kz_kind_period(kind);
  for (int q = 1; q <= period && atlas->plane.half_period; q += 2) {
    const int points = (q + 1) / 2, power = kind->side < 0 ? period / q : 2;
    double image[2];
    if (period % q != 0 || (kind->side < 0 ? q == period : q < period || kind->turns != 0)) continue;
    if (!kz_atlas_image_state(atlas, cycle->place, cycle->point[0], image) ||
        kz_atlas_apart(image, cycle->point[points % n], 1) >= near)
      continue;
    kz_cycle begin = begin_of(cycle, -1, points, 0);
    if (!kz_cycle_close(&atlas->plane, &begin) || !is_on_its_curve(atlas, power, &begin)) continue;
    *cycle = begin;
    return true;
  }
  return false;
}

bool kz_atlas_reduce(const kz_atlas *atlas, double near, kz_cycle *cycle) {
  const kz_cycle_kind *kind = &cycle->kind;
  const int n = kind->points;
  if (is_rest(atlas, near, cycle)) {
    *cycle = rest_of(cycle);
    return true;
  }
  for (int shift = 1; shift < n && !kind->rest; shift++)
    for (int side = 1; side >= -1 && n % shift == 0; side -= 2) {
      /* Half of a cycle is mirrored, or each odd part of one that is symmetric */
      const bool mirrored = kind->side < 0 ? n / shift % 2 == 1 : kind->turns == 0 && 2 * shift == n;
      if (side < 0 ? !atlas->plane.mirrored || !mirrored : kind->side < 0) continue;
      if (!cycles_repeats(cycle, shift, side, near)) continue;
      const double turned = (cycle->point[shift][0] + cycle->point[0][0]) / (2 * M_PI);
      kz_cycle begin = begin_of(cycle, side, shift, side < 0 ? (int32_t)rint(turned) : kind->turns * shift / n);
      if (!is_on_its_curve(atlas, n / shift, &begin)) continue;
      *cycle = begin;
      return true;
    }
  return reduce_to_image(atlas, near, cycle);
}

/* Angles from a point in [-pi, pi), of images that with positive turns, symmetric cycles about down or inverted. */
static bool cycles_canonical(const kz_atlas *atlas, kz_cycle *cycle) {
  kz_cycle_kind *kind = &cycle->kind;
  double lift = 2 * M_PI * floor(cycle->point[0][0] / (2 * M_PI) + 0.5);
  if (kind->side < 0) {
    const int32_t pairs = (kind->turns - (kind->turns & 1)) / 2;
    lift = 2 * M_PI * pairs;
    kind->turns -= 2 * pairs;
  } else if (kind->turns < 0 && kz_atlas_paired(atlas)) {
    kind->turns = -kind->turns;
    for (int i = 0; i < kind->points; i++)
      if (!kz_atlas_image_state(atlas, cycle->place, cycle->point[i], cycle->point[i])) return false;
    lift = 2 * M_PI * floor(cycle->point[0][0] / (2 * M_PI) + 0.5);
  }
  for (int i = 0; i < kind->points; i++) cycle->point[i][0] -= lift;
  return true;
}

bool kz_atlas_add(const kz_atlas *atlas, const kz_cycle *cycle, kz_atlas_seeds *seeds) {
  kz_cycle seed = *cycle;
  for (int i = 0; i < seed.kind.points; i++)
    if (!isfinite(seed.point[i][0]) || !isfinite(seed.point[i][1])) return false;
  for (int i = 0; i < 2; i++)
    if (!(seed.place[i] >= atlas->plane.low[i] && seed.place[i] <= atlas->plane.high[i])) return false;
  while (kz_atlas_reduce(atlas, ONE, &seed)) continue;
  if (kz_kind_period(&seed.kind) > atlas->scene->atlas->max_period) return false;
  if (!cycles_canonical(atlas, &seed)) return false;
  kz_atlas_put(seeds, &seed);
  return true;
}

void kz_atlas_put(kz_atlas_seeds *seeds, const kz_cycle *seed) {
  seeds->list = kz_list_reserve(seeds->list, &seeds->capacity, seeds->count + 1, sizeof *seeds->list);
  seeds->list[seeds->count++] = *seed;
}

void kz_atlas_seeds_free(kz_atlas_seeds *seeds) {
  free(seeds->list);
  *seeds = (kz_atlas_seeds){0};
}
