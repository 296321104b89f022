#include "rules.h"
#include "kapitza/study_basin.h"

kz_short_text kz_key_in(const char *mapping, const char *name) {
  kz_short_text path;
  snprintf(path.text, sizeof path.text, "%s.%s", mapping, name);
  return path;
}

static void complain_order(kz_reading *reading, const kz_axis *axis, const char *path) {
  kz_complain(reading, kz_key_in(path, "max").text, "%s is too small; it must be greater than min = %s",
              kz_shortest(axis->max).text, kz_shortest(axis->min).text);
}

void kz_axis_rules(kz_reading *reading, const kz_axis *axis, const char *path) {
  if (isnan(axis->min) || isnan(axis->max)) return;
  const double cell = (axis->max - axis->min) / (double)(axis->count > 0 ? axis->count : 1);
  if (axis->max <= axis->min)
    complain_order(reading, axis, path);
  else if (cell < DBL_MIN || cell < 8.0 * DBL_EPSILON * fmax(fabs(axis->min), fabs(axis->max)))
    kz_complain(reading, kz_key_in(path, "max").text,
                "%s leaves cells of width %g, too narrow for double precision; use a wider window or a smaller count",
                kz_shortest(axis->max).text, cell);
}

/* A window given by its centre. If doubles cannot distinguish its cells, the method must be exact. */
static void check_centred(kz_reading *reading, const kz_basin_plan *plan, const kz_axis *axis, const char *width) {
  const bool exact = isnan(plan->accuracy) && plan->method == KZ_METHOD_EXACT;
  const double cell = axis->width.high / (double)(axis->count > 0 ? axis->count : 1);
  if (kz_axis_is_deep(axis) && !exact)
    kz_complain(reading, width,
                "%s leaves cells of width %g, too narrow for double precision; choose basin.method exact",
                axis->width.text, cell);
}

void kz_axis_set(kz_reading *reading, const kz_basin_plan *plan, kz_edges edges, kz_axis *axis, const char *path) {
  const bool has_centre = axis->centre.text[0], has_width = axis->width.text[0];
  axis->min = edges.min;
  axis->max = edges.max;
  if (has_centre != has_width)
    kz_complain(reading, kz_key_in(path, has_centre ? "width" : "centre").text, "is missing beside %s; give both",
                has_centre ? "centre" : "width");
  if (!has_centre || !has_width) return;
  axis->min = axis->centre.high - axis->width.high / 2;
  axis->max = axis->centre.high + axis->width.high / 2;
  check_centred(reading, plan, axis, kz_key_in(path, "width").text);
}

void kz_theta_rules(kz_reading *reading, kz_axis *theta, const char *path) {
  const kz_short_text min = kz_key_in(path, "min"), max = kz_key_in(path, "max");
  const bool has_min = kz_tree_find(reading->root, min.text), has_max = kz_tree_find(reading->root, max.text);
  if (has_min && !has_max) kz_complain(reading, max.text, "is missing beside min; give both or neither");
  if (has_max && !has_min) kz_complain(reading, min.text, "is missing beside max; give both or neither");
  if (!has_min && !has_max) {
    theta->min = -M_PI;
    theta->max = M_PI;
  }
  kz_axis_rules(reading, theta, path);
  if (theta->max - theta->min > 2.0 * M_PI)
    kz_complain(reading, max.text,
                "%s makes the window %s rad wide; it must be at most 2 pi (degrees are written %s deg)",
                kz_shortest(theta->max).text, kz_shortest(theta->max - theta->min).text, kz_shortest(theta->max).text);
}

void kz_axis_ends_rules(kz_reading *reading, const kz_axis *axis, const char *path) {
  if (axis->count == 1 && axis->max != axis->min)
    kz_complain(reading, kz_key_in(path, "max").text, "%s differs from min = %s; they must be equal because count is 1",
                kz_shortest(axis->max).text, kz_shortest(axis->min).text);
  else if (axis->count > 1 && axis->max <= axis->min)
    complain_order(reading, axis, path);
}
