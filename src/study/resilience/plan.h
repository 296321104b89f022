/* Plan of the smallest shocks that leave a basin. The size of a shock is hypot(dtheta, dv / scale). */
#pragma once

#include "kapitza/study.h"

enum { KZ_MOST_SHOCK_SIZES = 16 };
struct kz_shocks_plan {
  double scale; /* velocity, rad per drive radian, that counts as much as 1 rad */
  kz_reals sizes;
};
