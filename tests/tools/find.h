/* Searches whose finds join the catalogue at once. */
#pragma once

#include <stdlib.h>

#include "kapitza/dynamics.h"

/* All cycles near n <= 64 states. */
static inline void find_cycles(kz_dynamics *d, int64_t n, const double *state, double closeness) {
  double *found = calloc((size_t)kz_dynamics_find_size(d, KZ_FIND_CYCLE), sizeof *found);
  while ((int64_t)found[0] < n) {
    kz_dynamics_find(d, KZ_FIND_CYCLE, n, state, closeness, found);
    kz_dynamics_adopt(d, found);
  }
  free(found);
}
