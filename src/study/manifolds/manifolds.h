/* Branches of manifolds of the cycles that the study `saddles` has written. */
#ifndef KAPITZA_STUDY_MANIFOLDS_H
#define KAPITZA_STUDY_MANIFOLDS_H

#include "kapitza/dynamics.h"
#include "kapitza/store.h"

enum { KZ_BRANCH_POINTS = 32768 /* of a branch, at most */ };

/* Sets the period of `branch` and its strobe point number `phase` from the group saddles of the file. */
kz_status kz_branch_read(kz_store *store, int64_t saddle, int64_t phase, kz_branch *branch);

#endif
