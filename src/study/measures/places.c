/* Where the points of a line or plane lie, and the pendulums between them. */
#include "points.h"

kz_points kz_points_of(const kz_scene *scene, const kz_integers *names) {
  const kz_sweep_plan *sweep = scene->sweep;
  const bool plane = kz_sweep_is_plane(sweep);
  kz_points points = {.scene = scene,
                      .plan = {.theta = sweep->theta,
                               .velocity = sweep->velocity,
                               .starts = sweep->starts,
                               .max_period = sweep->max_period,
                               .seed = sweep->seed,
                               .options = scene->swept->options},
                      .columns = plane ? sweep->x.values.count : sweep->values.count,
                      .rows = plane ? sweep->y.values.count : 1};
  points.plan.names = *names;
  for (int64_t i = 0; i < points.plan.names.count; i++) {
    const kz_measure_shape shape = kz_measures[points.plan.names.values[i]].shape;
    points.numbers += shape == KZ_PER_INTERVAL ? 3 : shape != KZ_PER_PENDULUM;
    points.of_pendulum += shape == KZ_PER_PENDULUM;
  }
  return points;
}

bool kz_points_pendulum(const kz_points *points, int64_t from, int64_t to, double share, kz_pendulum *pendulum) {
  const kz_sweep_plan *sweep = points->scene->sweep;
  const bool plane = kz_sweep_is_plane(sweep);
  const int32_t parameter[] = {plane ? sweep->x.parameter : sweep->parameter, sweep->y.parameter};
  const kz_axis *axis[] = {&sweep->x.values, &sweep->y.values};
  const int64_t a[] = {from % points->columns, from / points->columns},
                b[] = {to % points->columns, to / points->columns};
  double value[2];
  for (int i = 0; i < (plane ? 2 : 1); i++) {
    const double first = plane ? kz_axis_value(axis[i], a[i]) : kz_sweep_value(sweep, a[i]);
    const double last = plane ? kz_axis_value(axis[i], b[i]) : kz_sweep_value(sweep, b[i]);
    value[i] = share == 0 ? first : share == 1 ? last : first + share * (last - first);
  }
  return kz_pendulum_at(points->scene, plane ? 2 : 1, parameter, value, pendulum);
}
