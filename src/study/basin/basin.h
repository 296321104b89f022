/* Inside of the study `basin`: its parts. */
#ifndef KAPITZA_STUDY_BASIN_H
#define KAPITZA_STUDY_BASIN_H

#include "chunks.h"
#include "numerics/cells.h"
#include "labelling/doubt.h"
#include "resilience/resilience.h"

enum { KZ_TILE_CELLS = 16384 }; /* of a tile, about: so many that the few that take long hardly leave lanes empty */

/* What is known of a labelled window. */
typedef struct {
  int64_t cells;
  kz_counts counts;
  double trapped_share; /* of the cells of the trapping regions' grid */
  double step_error;    /* rad, the largest of one drive period in a sample */
  kz_doubt doubt;       /* of the labels */
  double table_error;   /* the same of the map table; NaN where labels do not come from it */
} kz_window_summary;

/* Axes and variables of group /basin, before the cells come. */
kz_status kz_basin_declare(const kz_scene *scene, const kz_tiles *tiles, kz_store *store);
/* Group /attractors, attributes of /basin, and the summary. */
kz_status kz_basin_write(const kz_scene *scene, const kz_catalogue *catalogue, const kz_window_summary *labels, kz_store *store,
                         FILE *summary);

/* The steps of a basin and their error beside its cells, and a line for each class of speeds that is off by more than
 * kz_steps_tolerance. Returns the largest error of a drive period, rad: an upper estimate. */
double kz_basin_warn_steps(const kz_scene *scene, FILE *summary);

/* What basin.shocks asks of all points. */
kz_resilience_plan kz_shocks_asked(const kz_basin_plan *plan);

bool kz_basin_wanted(const kz_scene *scene);
kz_cost kz_basin_cost(const kz_scene *scene);
kz_status kz_basin_check(const kz_scene *scene);
kz_status kz_basin_measure(const kz_scene *scene, double *seconds);
kz_status kz_basin_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

#endif
