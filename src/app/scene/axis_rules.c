#include "axis_rules.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

kz_shortest_text kz_shortest(double value) {
  kz_shortest_text number;
  kz_scalar_print(value, number.text);
  return number;
}

void kz_axis_rules(kz_reading *reading, const kz_axis *axis, const char *path) {
  char name[128];
  if (isnan(axis->min) || isnan(axis->max)) return;
  snprintf(name, sizeof name, "%s.max", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  const double cell = (axis->max - axis->min) / (double)(axis->count > 0 ? axis->count : 1);
  if (axis->max <= axis->min)
    kz_complain(reading, node, name, "%s is too small; it must be greater than min = %s", kz_shortest(axis->max).text,
                kz_shortest(axis->min).text);
  else if (cell < DBL_MIN || cell < 8.0 * DBL_EPSILON * fmax(fabs(axis->min), fabs(axis->max)))
    kz_complain(reading, node, name,
                "%s leaves cells of width %g, too narrow for double precision; use a wider window or a smaller count",
                kz_shortest(axis->max).text, cell);
}

static bool is_exact(const kz_basin_plan *plan) {
  return isnan(plan->accuracy) && plan->method == KZ_METHOD_EXACT;
}

/* A window given by its centre. If doubles cannot distinguish its cells, the method must be exact, and this build must have enough digits. */
static void check_centred(kz_reading *reading, const kz_basin_plan *plan, const kz_axis *axis, const char *path) {
  static const double least_of_quads = 1e-25;
  char name[128];
  snprintf(name, sizeof name, "%s.width", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  const double cell = axis->width.high / (double)(axis->count > 0 ? axis->count : 1);
  if (kz_axis_is_deep(axis) && !is_exact(plan))
    kz_complain(reading, node, name, "%s leaves cells of width %g, too narrow for double precision; choose basin.method exact",
                axis->width.text, cell);
  else if (axis->width.high < least_of_quads && kz_arbitrary_bits() < KZ_MOST_BITS)
    kz_complain(reading, node, name, "%s is too narrow for this build, which is without FLINT (Arb); it must be at least %g",
                axis->width.text, least_of_quads);
}

void kz_axis_set(kz_reading *reading, const kz_basin_plan *plan, kz_edges edges, kz_axis *axis, const char *path) {
  char name[128];
  axis->min = edges.min;
  axis->max = edges.max;
  if (!axis->centre.text[0] && !axis->width.text[0]) return;
  const bool has_centre = axis->centre.text[0];
  snprintf(name, sizeof name, "%s.%s", path, has_centre ? "width" : "centre");
  if (!has_centre || !axis->width.text[0]) {
    kz_complain(reading, NULL, name, "is missing beside %s; give both", has_centre ? "centre" : "width");
    return;
  }
  axis->min = axis->centre.high - axis->width.high / 2;
  axis->max = axis->centre.high + axis->width.high / 2;
  check_centred(reading, plan, axis, path);
}

void kz_theta_rules(kz_reading *reading, kz_axis *theta, const char *path) {
  char min[128], max[128];
  snprintf(min, sizeof min, "%s.min", path);
  snprintf(max, sizeof max, "%s.max", path);
  const kz_node *min_node = kz_tree_find(reading->root, min), *max_node = kz_tree_find(reading->root, max);
  if (min_node && !max_node) kz_complain(reading, NULL, max, "is missing beside min; give both or neither");
  if (max_node && !min_node) kz_complain(reading, NULL, min, "is missing beside max; give both or neither");
  if (!min_node && !max_node) {
    theta->min = -M_PI;
    theta->max = M_PI;
  }
  kz_axis_rules(reading, theta, path);
  if (theta->max - theta->min > 2.0 * M_PI)
    kz_complain(reading, max_node, max, "%s makes the window %s rad wide; it must be at most 2 pi (degrees are written %s deg)",
                kz_shortest(theta->max).text, kz_shortest(theta->max - theta->min).text, kz_shortest(theta->max).text);
}

void kz_ends_rules(kz_reading *reading, const kz_axis *axis, const char *path) {
  char name[128];
  snprintf(name, sizeof name, "%s.max", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  if (axis->count == 1 && axis->max != axis->min)
    kz_complain(reading, node, name, "%s differs from min = %s; they must be equal because count is 1",
                kz_shortest(axis->max).text, kz_shortest(axis->min).text);
  else if (axis->count > 1 && axis->max <= axis->min)
    kz_complain(reading, node, name, "%s is too small; it must be greater than min = %s", kz_shortest(axis->max).text,
                kz_shortest(axis->min).text);
}
