/* Plan for cells that quad precision does not decide. Centre and width of the window are those of the basin. */
#pragma once

#include "kapitza/study.h"

enum { KZ_UNDECIDED_FLAG = 0, KZ_UNDECIDED_DECIDE = 1 };
struct kz_deep_plan {
  int32_t undecided;
};
