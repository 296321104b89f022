/* Plan of the study `stability`. damping, quality_factor: NaN = not given; curves: indices of kz_curve_names(). */
#pragma once

#include "kapitza/study.h"

struct kz_stability_plan {
  kz_axis k, m; /* values with both ends; min NaN = given as a, q */
  kz_axis a, q; /* 4k, 2m; min NaN = given as k, m */
  double damping, quality_factor;
  kz_integers curves, subharmonics;
};
