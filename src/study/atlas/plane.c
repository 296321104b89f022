/* The plane of an atlas: places, their pendulums, what the plane has in common. */
#include "curves.h"
#include "cycles.h"

/* Curves are followed a little beyond the rectangle; below an undriven edge the plane is its own mirror image. */
static const double MARGIN = 0.06, BELOW = 0.004, LONGEST = 0.02;
enum { PLACES = 9 };

void kz_atlas_values(const kz_atlas_plan *plan, const double place[2], double value[2]) {
  value[0] = plan->x.values.min + place[0] * (plan->x.values.max - plan->x.values.min);
  value[1] = plan->y.values.min + place[1] * (plan->y.values.max - plan->y.values.min);
}

bool kz_atlas_pendulum(const void *context, const double place[2], kz_pendulum *pendulum) {
  const kz_scene *scene = context;
  const int32_t parameter[] = {scene->atlas->x.parameter, scene->atlas->y.parameter};
  double value[2];
  kz_atlas_values(scene->atlas, place, value);
  return kz_pendulum_at(scene, 2, parameter, value, pendulum) && pendulum->beta > 0;
}

static bool is_undriven(const kz_pendulum *p) {
  bool driven = p->m != 0 || p->unmirrored;
  for (int j = 0; j < p->harmonics; j++) driven = driven || p->vertical[j][0] != 0 || p->vertical[j][1] != 0;
  return !driven;
}

/* KZ_REFUSED where a key changes no motion: at no place of the plane. */
static kz_status check_keys(const kz_atlas *atlas) {
  const kz_scene *scene = atlas->scene;
  for (int axis = 0; axis < 2; axis++) {
    bool same = true;
    for (int i = 0; i < PLACES && same; i++) {
      kz_pendulum first, last;
      double low[2], high[2];
      low[1 - axis] = high[1 - axis] = (double)i / (PLACES - 1);
      low[axis] = 0.25;
      high[axis] = 0.75;
      same = kz_atlas_pendulum(scene, low, &first) && kz_atlas_pendulum(scene, high, &last) &&
             kz_pendulums_parted(&first, &last) == 0;
    }
    if (same)
      return kz_fail(KZ_REFUSED, "atlas.%c.parameter: %s changes no motion of this pendulum; name a key that does",
                     kz_atlas_axis(atlas, axis) ? 'y' : 'x',
                     kz_sweep_parameter_at(axis ? scene->atlas->y.parameter : scene->atlas->x.parameter)->name);
  }
  return KZ_OK;
}

/* Steps of the stiffest pendulum; what all places have in common. */
static kz_status plane_survey(kz_atlas *atlas) {
  const kz_scene *scene = atlas->scene;
  const kz_plane_axis *axis[] = {&scene->atlas->x, &scene->atlas->y};
  double stiffest = -1;
  bool rests = false; /* at some place of the lowest y: without gravity no rest attracts there */
  atlas->undriven = true;
  atlas->plane.mirrored = atlas->plane.half_period = 1;
  for (int i = 0; i < PLACES * PLACES; i++) {
    const double place[2] = {(double)(i % PLACES) / (PLACES - 1), (double)(i / PLACES) / (PLACES - 1)};
    kz_pendulum pendulum;
    double value[2];
    kz_numerics fine;
    if (!kz_atlas_pendulum(scene, place, &pendulum)) {
      char text[2][96];
      kz_atlas_values(scene->atlas, place, value);
      for (int j = 0; j < 2; j++)
        kz_axis_print(&axis[j]->values, axis[j]->parameter, 10, value[j], text[j], sizeof text[j]);
      return kz_fail(
          KZ_REFUSED,
          "atlas.x.min|atlas.y.min: there is no damped pendulum at %s, %s; an atlas needs damping above 0 in the whole "
          "rectangle",
          text[atlas->swapped], text[1 - atlas->swapped]);
    }
    if (!kz_is_mirrored(&pendulum)) atlas->plane.mirrored = 0;
    if (!(kz_symmetries(&pendulum) & KZ_SYMMETRY_HALF_PERIOD)) atlas->plane.half_period = 0;
    if (place[1] == 0) {
      if (!is_undriven(&pendulum)) atlas->undriven = false;
      rests = rests || pendulum.k != 0;
    }
    if (kz_stiffness(&pendulum) <= stiffest) continue;
    stiffest = kz_stiffness(&pendulum);
    if (stiffest > 1e4)
      return kz_fail(KZ_REFUSED, "atlas.x.max|atlas.y.max: the drive is too strong for an atlas; use smaller values");
    kz_numerics_fine(&pendulum, &fine);
    atlas->plane.steps = fine.steps_per_period;
  }
  atlas->undriven = atlas->undriven && rests;
  if (atlas->plane.mirrored) atlas->plane.half_period = 0;
  return KZ_OK;
}

/* Whether the motions of p, half a period later and upside down, are those of q: even harmonics, k and the
 * oscillating torque change their signs. */
static bool is_turned_pendulum(const kz_pendulum *p, const kz_pendulum *q) {
  static const double SAME = 1e-9;
  kz_pendulum turned = *p;
  turned.k = -p->k;
  turned.torque_amplitude = -p->torque_amplitude;
  for (int j = 1; j < KZ_HARMONICS; j += 2)
    for (int i = 0; i < 2; i++)
      turned.vertical[j][i] = -p->vertical[j][i], turned.horizontal[j][i] = -p->horizontal[j][i];
  return kz_pendulums_parted(&turned, q) < SAME;
}

/* Whether the place (1 - x, y), or (x, 1 - y), has the motions of (x, y) half a period later and upside down. */
static bool is_turned(const kz_atlas *atlas) {
  for (int i = 0; i < PLACES * PLACES; i++) {
    const double place[2] = {(i % PLACES + 0.5) / PLACES, (i / PLACES + 0.5) / PLACES};
    double image[2];
    kz_pendulum p, q;
    if (!kz_atlas_image(atlas, place, image) || !kz_atlas_pendulum(atlas->scene, image, &q)) continue;
    if (!kz_atlas_pendulum(atlas->scene, place, &p) || !is_turned_pendulum(&p, &q)) return false;
  }
  return true;
}

bool kz_atlas_image(const kz_atlas *atlas, const double place[2], double image[2]) {
  const kz_plane_axis *axis[] = {&atlas->scene->atlas->x, &atlas->scene->atlas->y};
  for (int i = 0; i < 2; i++) {
    const char *name = kz_sweep_parameter_at(axis[i]->parameter)->name;
    if (strcmp(name, "k") && strcmp(name, "gravity")) continue;
    const double low = axis[i]->values.min, width = axis[i]->values.max - low, value = low + place[i] * width;
    image[1 - i] = place[1 - i];
    image[i] = (-value - low) / width;
    return image[i] >= 0 && image[i] <= 1;
  }
  return false;
}

/* Whether x and y are to be exchanged: x alone begins undriven, or the drive grows more along x. */
static bool is_swapped(const kz_scene *scene) {
  const kz_atlas_plan *plan = scene->atlas;
  kz_pendulum pendulum;
  bool undriven[2] = {true, true};
  double end[2] = {0, 0};
  for (int axis = 0; axis < 2; axis++) {
    for (int i = 0; i < PLACES; i++) {
      double place[2];
      place[axis] = 0, place[1 - axis] = (double)i / (PLACES - 1);
      undriven[axis] = undriven[axis] && kz_atlas_pendulum(scene, place, &pendulum) && is_undriven(&pendulum);
    }
    if (kz_atlas_pendulum(scene, (double[]){axis == 0, axis == 1}, &pendulum)) end[axis] = kz_stiffness(&pendulum);
  }
  if (undriven[0] != undriven[1]) return undriven[0];
  return end[0] != end[1] ? end[0] > end[1] : plan->x.parameter > plan->y.parameter;
}

kz_status kz_atlas_begin(const kz_scene *scene, kz_atlas *atlas) {
  *atlas = (kz_atlas){.scene = scene, .longest = LONGEST, .reference = {0.0123, 0.0071}};
  atlas->swapped = is_swapped(scene);
  if (atlas->swapped) {
    atlas->own_scene = *scene;
    atlas->own_plan = *scene->atlas;
    atlas->own_plan.x = scene->atlas->y, atlas->own_plan.y = scene->atlas->x;
    atlas->own_scene.atlas = &atlas->own_plan;
    atlas->scene = &atlas->own_scene;
  }
  atlas->plane = (kz_plane){.pendulum = kz_atlas_pendulum,
                            .context = atlas->scene,
                            .low = {-MARGIN, -MARGIN},
                            .high = {1 + MARGIN, 1 + MARGIN}};
  KZ_TRY(plane_survey(atlas));
  KZ_TRY(check_keys(atlas));
  if (atlas->undriven) atlas->plane.low[1] = -BELOW;
  atlas->turned = is_turned(atlas);
  return KZ_OK;
}

void kz_atlas_end(kz_atlas *atlas) {
  for (int64_t i = 0; i < atlas->n_curves; i++) kz_atlas_curve_free(atlas->curve + i);
  free(atlas->curve);
  kz_atlas_seeds_free(&atlas->pending);
  kz_atlas_seeds_free(&atlas->sightings);
  free(atlas->sighting_place);
}
