/* Measures of how fractal the boundaries of a basin are, and of how long its transients last. */
#ifndef KAPITZA_STUDY_BASIN_BOUNDARY_H
#define KAPITZA_STUDY_BASIN_BOUNDARY_H

#include "attractors/catalogue.h"
#include "label.h"

/* Follows the pairs of starts and counts the boxes of cells that the key basin.boundary asks for; writes group /boundary and the summary.
 * Does nothing without this key. The cells must be in the store. Collective. */
kz_status kz_boundary_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                           kz_store *store, FILE *summary);

/* Writes the mean lifetime, from the tail of the settling times in the store, as attributes of /basin and a line of the summary. Rank 0. */
kz_status kz_lifetime_write(const kz_scene *scene, kz_store *store, FILE *summary);

#endif
