/* Plan of the study `tradeoff`, on the window of the study `basin`. */
#pragma once

#include "kapitza/study.h"

struct kz_tradeoff_plan {
  int64_t samples;      /* cells compared with quad precision */
  kz_integers settings; /* indices in the table of settings; empty = all */
};
