/* Plan of the boundaries of a basin. */
#pragma once

#include "kapitza/study.h"

enum { KZ_BOUNDARY_FEWEST_DECADES = 2, KZ_BOUNDARY_MOST_DECADES = 23 };
struct kz_boundary_plan {
  int64_t pairs, decades; /* starts; of their partners' distances */
  double farthest;        /* distance of the first partner, rad */
};
