/* Inside of the study `basin`: its parts. */
#ifndef KAPITZA_BASIN_H
#define KAPITZA_BASIN_H

#include "catalogue.h"
#include "kapitza/study.h"

/* Labels of all cells, velocity-major, on rank 0. */
typedef struct {
  int64_t cells;
  int16_t *attractor;
  uint32_t *settling_time;
  uint8_t *evidence;
  double trapped_share; /* of the map table's cells */
} kz_labels;

kz_status kz_labels_allocate(int64_t cells, kz_labels *labels);
void kz_labels_free(kz_labels *labels);

/* The own cells of a window as they are labelled so far, on rank 0. */
typedef struct {
  const kz_basin_plan *plan;
  const kz_dynamics *dynamics;
  int64_t total, own;
  const int16_t *owner;
  const uint32_t *periods;
} kz_grid;

/* mark [own]: of the marked cells those stay marked whose label the map table does not back: they have not started inside a
 * trapping region, and took longer than `horizon` periods, or have not settled, or differ from a neighbour. */
kz_status kz_grid_distrust(const kz_grid *grid, double horizon, uint8_t *mark);

/* Centre of cell i; exactly mirrored in a symmetric window. */
double kz_axis_centre(const kz_axis *axis, int64_t i);
bool kz_axis_is_symmetric(const kz_axis *axis);

/* Measures, groups /attractors and /basin, and the summary. Fractions of the catalogue are filled in. */
kz_status kz_basin_write(const kz_scene *scene, kz_catalogue *catalogue, const kz_labels *labels, kz_store *store,
                         FILE *summary);

bool kz_basin_wanted(const kz_scene *scene);
kz_cost kz_basin_cost(const kz_scene *scene);
kz_status kz_basin_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary);

#endif
