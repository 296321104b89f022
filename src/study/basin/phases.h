/* The share of a window whose starts end on the same attractor at every phase of the drive at which they are released. */
#ifndef KAPITZA_STUDY_BASIN_PHASES_H
#define KAPITZA_STUDY_BASIN_PHASES_H

#include "attractors/catalogue.h"
#include "label.h"

/* Releases the cells at the number of phases that the key basin.phases gives, and writes group /phases and the summary. Does nothing
 * without this key. Collective. */
kz_status kz_phases_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                         kz_store *store, FILE *summary);

/* Estimates the processor time of this from some of the cells and adds it to *seconds. */
kz_status kz_phases_measure(const kz_scene *scene, kz_dynamics *dynamics, double *seconds);

/* Bytes of memory that this needs. */
double kz_phases_bytes(const kz_basin_plan *plan);

#endif
