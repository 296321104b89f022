/* Whether the steps are fine enough for a sweep: some of its values are tried. */
#include "numerics/cells.h"
#include "numerics/step_check.h"
#include "sweep.h"

enum {
  VALUES = 17,  /* values tried, fewer if they take many steps */
  STEPS = 20000 /* a period, that these values take together */
};

/* The fastest start at any value of a sweep. */
static double fastest_of_sweep(const kz_scene *scene) {
  const double fastest = fmax(kz_axis_fastest(&scene->sweep->velocity), fabs(scene->sweep->start_velocity));
  return scene->has_basin ? fmax(fastest, kz_axis_fastest(&scene->basin->velocity)) : fastest;
}

static int64_t tried_values(const kz_scene *scene) {
  if (kz_sweep_is_plane(scene->sweep)) return 4;
  const int64_t affordable = STEPS / scene->numerics.steps_per_period;
  const int64_t n = affordable < 2 ? 2 : kz_smaller(affordable, VALUES);
  return n < scene->sweep->values.count ? n : scene->sweep->values.count;
}

/* Motions at corner i of a plane, where errors are largest. */
static bool motions_at_corner(const kz_scene *scene, int64_t i, kz_step_motions *motions) {
  const kz_sweep_plan *plan = scene->sweep;
  const int32_t parameter[] = {plan->x.parameter, plan->y.parameter};
  const double value[] = {i % 2 ? plan->x.values.max : plan->x.values.min,
                          i / 2 ? plan->y.values.max : plan->y.values.min};
  *motions = kz_motions_of(scene, fastest_of_sweep(scene), "numerics.steps_per_period|sweep");
  char text[2][96];
  kz_axis_print(&plan->x.values, plan->x.parameter, 6, value[0], text[0], sizeof text[0]);
  kz_axis_print(&plan->y.values, plan->y.parameter, 6, value[1], text[1], sizeof text[1]);
  snprintf(motions->where, sizeof motions->where, "at %s, %s, ", text[0], text[1]);
  return kz_sweep_has_points(plan) && kz_pendulum_at(scene, 2, parameter, value, &motions->pendulum) &&
         motions->pendulum.beta > 0;
}

/* Motions at tried value i of n; false where that is no pendulum, or nothing is followed without damping. */
static bool motions_at(const kz_scene *scene, int64_t i, int64_t n, kz_step_motions *motions) {
  const kz_sweep_plan *plan = scene->sweep;
  if (kz_sweep_is_plane(plan)) return motions_at_corner(scene, i, motions);
  const double value = kz_sweep_value(plan, i * (plan->values.count - 1) / (n - 1));
  *motions = kz_motions_of(scene, fastest_of_sweep(scene), "numerics.steps_per_period|sweep");
  if (kz_sweep_has_grid(scene)) kz_motions_label_cells(scene->basin, motions);
  char text[96];
  kz_axis_print(&plan->values, plan->parameter, 6, value, text, sizeof text);
  snprintf(motions->where, sizeof motions->where, "at %s, ", text);
  const bool damped_alone =
      !kz_sweep_measures(plan, KZ_SWEEP_RELEASE_ANGLE) && !kz_sweep_measures(plan, KZ_SWEEP_STROBE);
  return kz_sweep_pendulum(scene, value, &motions->pendulum) && (motions->pendulum.beta > 0 || !damped_alone);
}

kz_status kz_sweep_check(const kz_scene *scene) {
  kz_step_motions motions;
  const int64_t n = tried_values(scene);
  for (int64_t i = 0; i < n; i++) /* the ends first: the largest error is usually at one of them */
    if (motions_at(scene, (n - i) % n, n, &motions)) KZ_TRY(kz_motions_check(&motions));
  return KZ_OK;
}

void kz_sweep_warn_steps(const kz_scene *scene, FILE *summary) {
  const int64_t n = tried_values(scene);
  kz_speed_errors largest = {{0}, {0}};
  kz_step_motions motions, worst;
  for (int64_t i = 0; i < n; i++) {
    if (!motions_at(scene, i, n, &motions)) continue;
    const kz_speed_errors classes = kz_motions_errors(&motions);
    if (kz_worst_error(&classes) <= kz_worst_error(&largest)) continue;
    largest = classes;
    worst = motions;
  }
  if (kz_worst_error(&largest) > 0) kz_motions_warn(&worst, &largest, summary);
}
