/* Boundaries of a basin: share of pairs of starts that end differently, by their distance; boxes of cells. */
#pragma once

#include "basin/basin.h"
#include "kapitza/analysis_boundary.h"
#include "plan.h"

extern const kz_basin_part kz_boundary_part;

enum { KZ_PAIR_DISTANCES = KZ_BOUNDARY_MOST_DECADES + 1 };

/* How many distances the plan asks for. */
int kz_distances_of(const kz_boundary_plan *plan);

/* uncertain [kz_distances_of]: evenly spread starts of the window, with a partner at every distance. Collective. */
kz_status kz_pairs_count(const kz_boundary_plan *plan, const kz_window_labels *labelling, kz_uncertain *uncertain);
