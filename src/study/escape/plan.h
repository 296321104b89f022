/* What a scene says of the study `escape`. */
#pragma once

#include "kapitza/study.h"

struct kz_escape_plan {
  kz_integers from; /* ids of attractors; empty = all */
  bool everywhere;  /* paths into every basin, not only out of each */
  int64_t starts;   /* of the minimiser, for each attractor and saddle */
};
