#include "cells.h"
#include "kapitza/dynamics_labels.h"

#include <float.h>

__float128 kz_decimal_quad(const char *text) {
  static const char radians[] = "0.0174532925199432957692369076848861271344";
  char *end;
  const __float128 number = strtof128(text, &end);
  return strcmp(end, " deg") == 0 ? number * strtof128(radians, NULL) : number;
}

static __float128 quad_of(const kz_decimal *decimal) {
  return (__float128)decimal->high + decimal->low;
}

static void cells_split(__float128 value, double pair[2]) {
  pair[0] = (double)value;
  pair[1] = (double)(value - pair[0]);
}

void kz_axis_at(const kz_axis *axis, double share, double offset, double pair[2]) {
  if (kz_axis_is_centred(axis))
    cells_split((share - 0.5) * quad_of(&axis->width) + quad_of(&axis->centre) + offset, pair);
  else
    cells_split((__float128)(axis->min + share * (axis->max - axis->min)) + offset, pair);
}

bool kz_axis_is_centred(const kz_axis *axis) {
  return axis->centre.text[0] != '\0';
}

bool kz_plan_is_centred(const kz_basin_plan *plan) {
  return kz_axis_is_centred(&plan->theta) || kz_axis_is_centred(&plan->velocity);
}

__float128 kz_axis_width(const kz_axis *axis) {
  return kz_axis_is_centred(axis) ? kz_decimal_quad(axis->width.text) : (__float128)axis->max - axis->min;
}

__float128 kz_axis_share(const kz_axis *axis, int64_t i) {
  if (kz_axis_is_centred(axis)) return (double)(2 * i + 1 - axis->count) / (2.0 * (double)axis->count);
  return (kz_axis_centre(axis, i) - (__float128)((axis->min + axis->max) / 2)) / kz_axis_width(axis);
}

double kz_axis_place(const kz_axis *axis, int64_t i, double pair[2]) {
  if (!kz_axis_is_centred(axis)) {
    cells_split(kz_axis_centre(axis, i), pair);
    return 0;
  }
  cells_split(kz_decimal_quad(axis->centre.text) + kz_axis_share(axis, i) * kz_axis_width(axis), pair);
  return 0x1p-103 * fmax(1, fabs(pair[0]));
}

double kz_axis_random(const kz_axis *axis, const uint64_t bits[2], double pair[2]) {
  const __float128 cells_width = kz_axis_width(axis),
                   share = ((__float128)bits[0] + (__float128)bits[1] * 0x1p-53) * 0x1p-53;
  cells_split(
      (kz_axis_is_centred(axis) ? kz_decimal_quad(axis->centre.text) - cells_width / 2 : (__float128)axis->min) +
          cells_width * share,
      pair);
  return (double)cells_width * 0x1p-105 + 0x1p-103 * fmax(1, fabs(pair[0]));
}

bool kz_axis_is_deep(const kz_axis *axis) {
  return axis->centre.text[0] &&
         axis->width.high / (double)axis->count < 8.0 * DBL_EPSILON * fmax(fabs(axis->min), fabs(axis->max));
}

double kz_axis_centre(const kz_axis *axis, int64_t i) {
  const int64_t halves =
      2 * i + 1 - axis->count; /* distance from the centre in half cells; a quad has more digits than a pair */
  if (kz_axis_is_centred(axis))
    return (double)((__float128)halves * (quad_of(&axis->width) / (__float128)(2 * axis->count)) +
                    quad_of(&axis->centre));
  return (double)halves * ((axis->max - axis->min) / (2.0 * (double)axis->count)) + (axis->min + axis->max) / 2;
}

kz_coordinate kz_axis_coordinate(const kz_axis *axis, int64_t i) {
  if (!kz_axis_is_centred(axis)) return (kz_coordinate){.high = kz_axis_centre(axis, i)};
  return (kz_coordinate){
      .centre = axis->centre.text, .width = axis->width.text, .share = (double)kz_axis_share(axis, i)};
}

double kz_axis_fastest(const kz_axis *velocity) {
  return fmax(fabs(velocity->min), fabs(velocity->max));
}

bool kz_axis_is_circle(const kz_axis *theta) {
  return theta->max - theta->min == 2 * M_PI;
}

double kz_axis_step(const kz_axis *axis) {
  return (axis->centre.text[0] ? axis->width.high : axis->max - axis->min) / (double)axis->count;
}

static double axis_width(const kz_axis *axis) {
  return kz_axis_step(axis) * (double)axis->count > DBL_EPSILON ? kz_axis_step(axis) : INFINITY;
}

double kz_cell_size(const kz_basin_plan *plan) {
  return fmin(axis_width(&plan->theta), axis_width(&plan->velocity));
}

/* Half of the width that is added to a window whose cells doubles cannot distinguish. */
static double cells_margin(const kz_axis *axis) {
  static const double around = 5e-7;
  return kz_axis_is_deep(axis) ? around : 0;
}

kz_window kz_motions_window(const kz_axis *theta, const kz_axis *velocity) {
  static const double swift = 2.5; /* rad per drive radian: rotations at twice the drive's rate */
  kz_window window = kz_window_of(theta, velocity);
  if (!kz_axis_is_deep(velocity) && !kz_axis_is_deep(theta)) return window;
  window.velocity_min = fmin(window.velocity_min, -swift);
  window.velocity_max = fmax(window.velocity_max, swift);
  return window;
}

kz_window kz_window_of(const kz_axis *theta, const kz_axis *velocity) {
  return (kz_window){theta->min - cells_margin(theta), theta->max + cells_margin(theta),
                     velocity->min - cells_margin(velocity), velocity->max + cells_margin(velocity)};
}

static bool is_symmetric(const kz_axis *axis) {
  return axis->min == -axis->max && axis->centre.high == 0;
}

bool kz_window_mirrors_itself(const kz_basin_plan *plan) {
  return is_symmetric(&plan->theta) && is_symmetric(&plan->velocity);
}

int64_t kz_unique_cells(const kz_basin_plan *plan) {
  const int64_t total = plan->theta.count * plan->velocity.count;
  return !plan->unmirrored && kz_window_mirrors_itself(plan) ? (total + 1) / 2 : total;
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

int32_t kz_stencil(kz_interpolation interpolation) {
  return interpolation == KZ_LINEAR ? 2 : 6;
}

const char *const kz_method_names[] = {KZ_METHOD_WORDS};
const char *const kz_interpolation_names[] = {KZ_INTERPOLATION_WORDS};

int64_t kz_tile_cells(const kz_scene *scene, int64_t most) {
  static const double tile_kicks = 4e9; /* some seconds, where all cells take max_periods */
  enum { FEWEST = 16 };
  const double kicks = (double)kz_scheme_at(scene->numerics.scheme).kicks * scene->numerics.steps_per_period;
  const double enough = tile_kicks / (kicks * (double)scene->basin->max_periods);
  return (int64_t)fmax(FEWEST, fmin((double)most, FEWEST * floor(enough / FEWEST)));
}
