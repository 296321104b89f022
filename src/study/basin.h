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
  int64_t undecided;    /* cells whose label the last place of the start changes, where that was asked */
  double trapped_share; /* of the map table's cells */
  double step_error;    /* rad, the largest of one drive period in a sample */
  double table_error;   /* the same of the map table; NaN where labels do not come from it */
} kz_labels;

kz_status kz_labels_allocate(int64_t cells, kz_labels *labels);
void kz_labels_free(kz_labels *labels);

/* Centre of cell i; exactly mirrored in a symmetric window. */
double kz_axis_centre(const kz_axis *axis, int64_t i);
bool kz_axis_is_symmetric(const kz_axis *axis);
/* Cells that are labelled; the others of a window that is its own mirror image mirror them. */
int64_t kz_own_cells(const kz_basin_plan *plan);
/* State of cell f, velocity-major: half-turns in [-1, 1] and velocity. */
void kz_cell_state(const kz_basin_plan *plan, int64_t f, double state[2]);

/* Nodes an axis that an interpolation (KZ_LINEAR, ...) takes. */
extern const int32_t kz_stencil[];

/* kz_dynamics_follow by a method (KZ_METHOD_ICM, ...); integrated [n]: periods for which hybrid left the table. */
void kz_follow(kz_dynamics *dynamics, int32_t method, int32_t interpolation, int64_t n, int64_t max_periods, double *state,
               int32_t *owner, int64_t *periods, int64_t *integrated);

/* Measures, groups /attractors and /basin, and the summary. Fractions of the catalogue are filled in. */
kz_status kz_basin_write(const kz_scene *scene, kz_catalogue *catalogue, const kz_labels *labels, kz_store *store,
                         FILE *summary);

bool kz_basin_wanted(const kz_scene *scene);
kz_cost kz_basin_cost(const kz_scene *scene);
kz_status kz_basin_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary);

#endif
