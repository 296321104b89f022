/* What a scene says of the study `tangency`: where, along a key of the pendulum, manifolds of the cycles that the study `saddles` of the same scene
 * finds begin to cross. */
#pragma once

#include "kapitza/study.h"

struct kz_tangency_plan {
  kz_plane_axis axis;   /* the count is not used */
  int64_t saddle, into; /* ids: the cycle of the unstable manifold, that of the stable one; KZ_UNSET_INTEGER = the same */
  double length;        /* of each branch */
};
