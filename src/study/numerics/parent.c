#include "parent.h"

#include <math.h>
#include <string.h>

/* The means of the pairs of points that lie half a period apart; side -1: of a point and the mirror image of the other. */
static bool take_means(int points, double side, const double *cycle, double near, double *y) {
  const double lift = 2 * M_PI * rint((cycle[2 * points] - side * cycle[0]) / (2 * M_PI));
  if (!(fabs(cycle[2 * points] - lift - side * cycle[0]) <= near)) return false;
  for (int i = 0; i < points; i++) {
    const double *other = cycle + 2 * (i + points);
    y[2 * i] = 0.5 * (cycle[2 * i] + side * (other[0] - lift));
    y[2 * i + 1] = 0.5 * (cycle[2 * i + 1] + side * other[1]);
  }
  return true;
}

kz_curve_kind kz_kind_of(const kz_plane *plane, int side, int points, int multiplier, const double *y) {
  double next[4] = {y[2 * points - 2], y[2 * points - 1]};
  if (!kz_curve_orbit(plane, y + 2 * points, 1, next)) return (kz_curve_kind){0};
  return (kz_curve_kind){side, points, multiplier, (int32_t)rint((next[2] - side * y[0]) / (2 * M_PI))};
}

kz_curve_kind kz_parent_of(const kz_plane *plane, int event, int n, const double *cycle, double near, double *parent) {
  const bool at_rest = event == KZ_EVENT_REST || (event == KZ_EVENT_MIRROR && n == 1);
  const int points = at_rest ? 1 : n / 2, side = event == KZ_EVENT_MIRROR ? -1 : 1;
  if (at_rest)
    parent[0] = cos(cycle[0]) < 0 ? M_PI : 0, parent[1] = 0;
  else if (n % 2 != 0 || !take_means(points, side, cycle, near, parent))
    return (kz_curve_kind){0};
  memcpy(parent + 2 * points, cycle + 2 * n, 2 * sizeof *parent);
  return kz_kind_of(plane, side, points, -1, parent);
}
