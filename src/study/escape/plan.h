/* Plan of the study `escape`. */
#pragma once

#include "kapitza/study.h"

enum { KZ_ESCAPE_MOST_PATCH = 32 };
struct kz_escape_plan {
  kz_integers from;      /* ids of attractors; empty = all */
  bool everywhere;       /* paths into every basin, not only out of each */
  int64_t starts;        /* starts of the minimiser for each attractor and saddle */
  kz_reals temperatures; /* at which lives are counted; empty = none */
  int64_t walkers;       /* for each attractor and temperature */
  int64_t max_periods;   /* for which one is followed */
  kz_plane_axis x, y;    /* over which barriers are continued; parameter KZ_UNSET_WORD = none */
  int64_t patch;         /* values of an axis between two searches */
  double angle;          /* rad from the attractor's motion at a strobe, beyond which a life has ended */
};
