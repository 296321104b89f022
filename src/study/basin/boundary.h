/* Measures of how fractal the boundaries of a basin are. */
#ifndef KAPITZA_STUDY_BASIN_BOUNDARY_H
#define KAPITZA_STUDY_BASIN_BOUNDARY_H

#include "attractors/catalogue.h"
#include "label.h"

/* Follows the pairs of starts and counts the boxes of cells that the key basin.boundary asks for; writes group /boundary and the summary.
 * Does nothing without this key. The cells must be in the store. Collective. */
kz_status kz_boundary_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                           kz_store *store, FILE *summary);

#endif
