/* Study `basin`, method hybrid: which labels of interpolated cell mapping are not to be trusted. */
#include <math.h>
#include <stdlib.h>

#include "basin.h"

/* Number of the attractor of any cell of the window; cells beyond the own ones mirror them. */
static int32_t owner_of(const kz_grid *grid, const int32_t *mirror, int64_t f) {
  return f < grid->own ? grid->owner[f] : mirror[grid->owner[grid->total - 1 - f]];
}

static bool differs_from_neighbour(const kz_grid *grid, const int32_t *mirror, int64_t f) {
  int64_t width = grid->plan->theta.count, column = f % width;
  bool circle = grid->plan->theta.max - grid->plan->theta.min == 2 * M_PI;
  int64_t left = column > 0 ? f - 1 : circle ? f + width - 1 : f;
  int64_t right = column < width - 1 ? f + 1 : circle ? f - width + 1 : f;
  int64_t below = f >= width ? f - width : f, above = f + width < grid->total ? f + width : f;
  int32_t own = owner_of(grid, mirror, f);
  return owner_of(grid, mirror, left) != own || owner_of(grid, mirror, right) != own || owner_of(grid, mirror, below) != own ||
         owner_of(grid, mirror, above) != own;
}

bool kz_distrusted(int32_t owner, int64_t periods, double horizon, bool differs) {
  return owner == 0 || (periods > 0 && ((double)periods > horizon || differs));
}

kz_status kz_grid_distrust(const kz_grid *grid, double horizon, uint8_t *mark) {
  int64_t known = kz_dynamics_count(grid->dynamics);
  int32_t *mirror = calloc((size_t)known + 1, sizeof *mirror);
  double *points = calloc(2 * (size_t)kz_dynamics_packed_size(grid->dynamics), sizeof *points);
  kz_status status = mirror && points ? KZ_OK : kz_fail(KZ_FAILED, "no memory for the neighbours of cells");
  for (int64_t number = 1; status == KZ_OK && number <= known; number++) {
    kz_attractor row;
    kz_dynamics_attractor(grid->dynamics, number, &row, points, points + kz_dynamics_packed_size(grid->dynamics));
    mirror[number] = row.mirror;
  }
  for (int64_t f = 0; status == KZ_OK && f < grid->own; f++)
    mark[f] = mark[f] && kz_distrusted(grid->owner[f], grid->periods[f], horizon, differs_from_neighbour(grid, mirror, f));
  free(mirror);
  free(points);
  return status;
}
