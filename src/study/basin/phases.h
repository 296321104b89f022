/* How much of a window ends alike whenever it is released. */
#ifndef KAPITZA_STUDY_BASIN_PHASES_H
#define KAPITZA_STUDY_BASIN_PHASES_H

#include "attractors/catalogue.h"
#include "label.h"

/* The study's key `phases`: the cells released at so many phases of the drive, into group /phases and the summary; nothing where it is not
 * asked for. Collective. */
kz_status kz_phases_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                         kz_store *store, FILE *summary);

/* What they take, seconds of processor time from some of the cells, is added to *seconds. */
kz_status kz_phases_measure(const kz_scene *scene, kz_dynamics *dynamics, double *seconds);

/* Bytes of memory. */
double kz_phases_bytes(const kz_basin_plan *plan);

#endif
