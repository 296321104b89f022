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
  double step_error;    /* rad, the largest of one drive period in a sample */
  double table_error;   /* the same of the map table; NaN where labels do not come from it */
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

/* Whether the map table does not back a label: the cell has not started inside a trapping region, and took longer than `horizon`
 * periods, or has not settled (owner 0), or differs from a neighbour. */
bool kz_distrusted(int32_t owner, int64_t periods, double horizon, bool differs);

/* mark [own]: of the marked cells those stay marked whose label is distrusted. */
kz_status kz_grid_distrust(const kz_grid *grid, double horizon, uint8_t *mark);

/* Centre of cell i; exactly mirrored in a symmetric window. */
double kz_axis_centre(const kz_axis *axis, int64_t i);
bool kz_axis_is_symmetric(const kz_axis *axis);
/* Cells that are labelled; the others of a window that is its own mirror image mirror them. */
int64_t kz_own_cells(const kz_basin_plan *plan);
/* State of cell f, velocity-major: half-turns in [-1, 1] and velocity. */
void kz_cell_state(const kz_basin_plan *plan, int64_t f, double state[2]);

/* Nodes an axis that an interpolation (KZ_LINEAR, ...) takes. */
extern const int32_t kz_stencil[];

/* Measures, groups /attractors and /basin, and the summary. Fractions of the catalogue are filled in. */
kz_status kz_basin_write(const kz_scene *scene, kz_catalogue *catalogue, const kz_labels *labels, kz_store *store,
                         FILE *summary);

bool kz_basin_wanted(const kz_scene *scene);
kz_cost kz_basin_cost(const kz_scene *scene);
kz_status kz_basin_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary);

#endif
