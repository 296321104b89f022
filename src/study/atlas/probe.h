/* What attracts at a place, by following starts. */
#pragma once

#include "types.h"

/* The dynamics of a place, with so many steps a period where the pendulum is gentle; NULL if there is no pendulum. The caller frees it. */
kz_dynamics *kz_atlas_dynamics(const kz_atlas *atlas, const double place[2], int steps, kz_pendulum *pendulum);
/* The attractors of a place by following starts, and where the mirror symmetry is broken also the images of what these end on. */
kz_status kz_atlas_probe_at(const kz_atlas *atlas, const double place[2], int64_t starts, int64_t seed, kz_atlas_seeds *found);

/* The cycle of n periods near n points, if the trace of its map, for a symmetric cycle of its half, is below `steepest` times that of a
 * multiplier of 1: 1 = it attracts. */
bool kz_atlas_identify(const kz_atlas *atlas, const double place[2], const double *points, int n, double steepest,
                       kz_plane_cycle *cycle);
