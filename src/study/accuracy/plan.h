/* What a scene says of the study `tradeoff`, on the window of the study `basin`. */
#ifndef KAPITZA_STUDY_ACCURACY_PLAN_H
#define KAPITZA_STUDY_ACCURACY_PLAN_H

#include "kapitza/study.h"

struct kz_tradeoff_plan {
  int64_t samples;      /* cells compared with quad precision */
  kz_integers settings; /* indices in the table of settings; empty = all */
};

#endif
