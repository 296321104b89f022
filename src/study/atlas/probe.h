/* Attractors of a place, by following starts. */
#pragma once

#include "types.h"

/* Makes the dynamics of a place, `steps` a period for a gentle pendulum; NULL without pendulum. The caller frees it. */
kz_dynamics *kz_atlas_dynamics(const kz_atlas *atlas, const double place[2], int steps, kz_pendulum *pendulum);
/* Finds attractors of a place by following starts; without mirror symmetry also from images of what these reach. */
kz_status kz_atlas_probe_at(const kz_atlas *atlas, const double place[2], int64_t starts, int64_t seed,
                            kz_atlas_seeds *found);

/* A cycle becomes the one near its points, of its own kind, if the trace of its map, for a symmetric cycle of its half,
 * is below `steepest` times that of a multiplier of 1: 1 = it attracts. */
bool kz_atlas_identify(const kz_atlas *atlas, kz_cycle *cycle, double steepest);
