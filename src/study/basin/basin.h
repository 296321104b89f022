/* Inside of the study `basin`: its parts. */
#ifndef KAPITZA_STUDY_BASIN_H
#define KAPITZA_STUDY_BASIN_H

#include "chunks.h"
#include "numerics/cells.h"
#include "labelling/doubt.h"
#include "resilience/resilience.h"

enum { KZ_TILE_CELLS = 16384 }; /* cells of a tile, about: enough to keep all lanes busy while a few cells take long */

/* Totals of a labelled window. */
typedef struct {
  int64_t cells;
  kz_counts counts;
  double trapped_share; /* share of the cells of the trapping regions' grid that are trapped */
  double step_error;    /* rad: the largest error of one drive period in a sample */
  kz_doubt doubt;       /* of the labels */
  double table_error;   /* rad: the same of the map table; NaN without a table */
} kz_window_summary;

/* Declares axes and variables of group /basin, before the cells are written. */
kz_status kz_basin_declare(const kz_scene *scene, const kz_tiles *tiles, kz_store *store);
/* Writes group /attractors, the attributes of /basin, and the summary. */
kz_status kz_basin_write(const kz_scene *scene, const kz_catalogue *catalogue, const kz_window_summary *labels, kz_store *store,
                         FILE *summary);

/* Prints the steps of a basin and their error, and a warning for each class of speeds whose error exceeds kz_steps_tolerance. Returns an
 * upper estimate of the largest error of a drive period, rad. */
double kz_basin_warn_steps(const kz_scene *scene, FILE *summary);

/* The plan of basin.shocks, for all strobe points. */
kz_resilience_plan kz_shocks_asked(const kz_basin_plan *plan);

kz_cost kz_basin_cost(const kz_scene *scene);
kz_status kz_basin_check(const kz_scene *scene);
kz_status kz_basin_measure(const kz_scene *scene, double *seconds);
kz_status kz_basin_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_basin_variables[], kz_phases_variables[], kz_boundary_variables[], kz_shocks_variables[];

#endif
