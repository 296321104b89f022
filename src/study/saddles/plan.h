/* Plan of the study `saddles`: all cycles up to max_period with a point in the window; counts are ignored. */
#pragma once

#include "kapitza/study.h"

enum { KZ_SADDLES_MAX_PERIOD = 32, KZ_SADDLES_MOST = 200000 /* cycles */ };
struct kz_saddles_plan {
  kz_axis theta, velocity;
  int64_t max_period;
};
