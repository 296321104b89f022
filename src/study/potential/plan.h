/* Plan of the study `potential`. */
#pragma once

#include "kapitza/study.h"

struct kz_potential_plan {
  kz_reals drive_amplitudes;
  int64_t theta_count;
};
