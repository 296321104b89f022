#include "cells.h"

#include <float.h>
#include <math.h>

double kz_axis_centre(const kz_axis *axis, int64_t i) {
  return (double)(2 * i + 1 - axis->count) * ((axis->max - axis->min) / (2.0 * (double)axis->count)) +
         (axis->min + axis->max) / 2;
}

double kz_axis_fastest(const kz_axis *velocity) {
  return fmax(fabs(velocity->min), fabs(velocity->max));
}

static double width(const kz_axis *axis) {
  const double extent = axis->max - axis->min;
  return extent > DBL_EPSILON ? extent / (double)axis->count : INFINITY;
}

double kz_cell_size(const kz_basin_plan *plan) {
  return fmin(width(&plan->theta), width(&plan->velocity));
}

kz_window kz_window_of(const kz_axis *theta, const kz_axis *velocity) {
  return (kz_window){theta->min, theta->max, velocity->min, velocity->max};
}

static bool is_symmetric(const kz_axis *axis) {
  return axis->min == -axis->max;
}

int64_t kz_own_cells(const kz_basin_plan *plan) {
  const int64_t total = plan->theta.count * plan->velocity.count;
  return is_symmetric(&plan->theta) && is_symmetric(&plan->velocity) ? (total + 1) / 2 : total;
}

void kz_start_state(double theta, double velocity, double state[2]) {
  const double half_turns = theta / M_PI;
  state[0] = half_turns - 2 * rint(half_turns / 2);
  state[1] = velocity;
}

void kz_cell_start(const kz_basin_plan *plan, int64_t f, double start[2]) {
  start[0] = kz_axis_centre(&plan->theta, f % plan->theta.count);
  start[1] = kz_axis_centre(&plan->velocity, f / plan->theta.count);
}

void kz_cell_state(const kz_basin_plan *plan, int64_t f, double state[2]) {
  double start[2];
  kz_cell_start(plan, f, start);
  kz_start_state(start[0], start[1], state);
}

int32_t kz_stencil(int32_t interpolation) {
  return 2 * interpolation + 2;
}

const char *const kz_method_names[] = {KZ_METHOD_WORDS};
const char *const kz_interpolation_names[] = {KZ_INTERPOLATION_WORDS};
const char *const kz_precision_names[] = {KZ_PRECISION_WORDS};

int32_t kz_way(int32_t method, int32_t interpolation) {
  return method == KZ_METHOD_ICM ? kz_stencil(interpolation) : KZ_FOLLOW_DIRECT;
}

int64_t kz_tile_cells(const kz_scene *scene, int64_t most) {
  static const double tile_kicks = 4e9; /* of double precision: some seconds, where all cells take max_periods */
  static const double cost[] = {[KZ_SINGLE] = 0.5, [KZ_DOUBLE] = 1, [KZ_QUAD] = 2500};
  enum { FEWEST = 16 };
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  const double kicks = cost[scene->numerics.precision] * scheme.kicks * scene->numerics.steps_per_period;
  const double enough = tile_kicks / (kicks * (double)scene->basin.max_periods);
  return (int64_t)fmax(FEWEST, fmin((double)most, FEWEST * floor(enough / FEWEST)));
}
