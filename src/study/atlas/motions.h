/* Motions of the list of a place. */
#pragma once

#include "types.h"

/* Solves for the motions of the list of a place; `known`: attractors that starts have found there. *listed = length of
 * the list, one for each pair of mirror images; *unsolved = those that were not found; both 0 where the list is not
 * known. */
void kz_atlas_confirm(kz_atlas *atlas, const double place[2], const kz_atlas_seeds *known, int64_t *listed,
                      int64_t *unsolved);
