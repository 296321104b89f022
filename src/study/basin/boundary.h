/* How fractal the boundaries of a basin are, in numbers; how long its transients last. */
#ifndef KAPITZA_STUDY_BASIN_BOUNDARY_H
#define KAPITZA_STUDY_BASIN_BOUNDARY_H

#include "attractors/catalogue.h"
#include "label.h"

/* The study's key `boundary`: pairs of starts and boxes of cells, into group /boundary and the summary; nothing where it is not asked
 * for. The cells are in the store. Collective. */
kz_status kz_boundary_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                           kz_store *store, FILE *summary);

/* What the pairs take, seconds of processor time from some of them, is added to *seconds. */
kz_status kz_boundary_measure(const kz_basin_plan *plan, kz_dynamics *dynamics, double *seconds);

/* Mean lifetime of the tail of the settling times, of the cells in the store: attributes of /basin, and a line. Rank 0. */
kz_status kz_lifetime_write(const kz_scene *scene, kz_store *store, FILE *summary);

#endif
