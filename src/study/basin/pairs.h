/* Pairs of starts beside each other: how many of them end differently, by their distance. */
#ifndef KAPITZA_STUDY_BASIN_PAIRS_H
#define KAPITZA_STUDY_BASIN_PAIRS_H

#include "kapitza/analysis.h"
#include "label.h"

enum { KZ_PAIR_DISTANCES = KZ_BOUNDARY_MOST_DECADES + 1 };

/* How many distances the plan asks for. */
int kz_distances_of(const kz_basin_plan *plan);

/* KZ_OK where the numbers behind the labels tell the nearest pairs apart. */
kz_status kz_pairs_check(const kz_basin_plan *plan);

/* uncertain [kz_distances_of]: of evenly spread starts of the window, each with a partner at every distance. Collective. */
kz_status kz_pairs_count(const kz_basin_plan *plan, const kz_window_labels *labelling, kz_uncertain *uncertain);

/* What the pairs take, seconds of processor time from some of them, is added to *seconds. */
kz_status kz_pairs_measure(const kz_basin_plan *plan, const kz_window_labels *labelling, double *seconds);

#endif
