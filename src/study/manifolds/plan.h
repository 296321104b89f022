/* What a scene says of the study `manifolds`: those of the cycles that the study `saddles` of the same scene finds. */
#pragma once

#include "kapitza/study.h"

enum { KZ_BRANCH_POINTS = 32768 /* of a branch, at most */ };
enum { KZ_MANIFOLDS_BOTH, KZ_MANIFOLDS_STABLE, KZ_MANIFOLDS_UNSTABLE };
struct kz_manifolds_plan {
  kz_integers saddles; /* ids; none = all */
  int32_t kind;
  double length, spacing, max_speed;
};
