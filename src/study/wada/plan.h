/* What a scene says of the study `wada`: the unstable manifolds of the cycles that the study `saddles` of the same scene finds. */
#pragma once

#include "kapitza/study.h"

struct kz_wada_plan {
  double length, spacing, max_speed;
};
