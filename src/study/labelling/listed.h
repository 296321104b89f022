/* Motions that an earlier study wrote to the group attractors or saddles, read back on every rank. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/parallel.h"
#include "kapitza/store.h"

typedef struct {
  int64_t count, phases;
  double *period;           /* [count] 0 = chaotic; this array is the block that holds all of them */
  double *mirror;           /* [count] id of the mirror image, -1 = there is none */
  double *theta, *velocity; /* [count][phases] strobe points, rad and rad per drive radian; NaN beyond the period */
  double *lyapunov;         /* [count], of attractors only */
} kz_listed;

/* Reads them; `dimension`: attractor or saddle; store NULL except on rank 0. Collective. kz_listed_free in any case. */
kz_status kz_listed_read(const kz_run *run, kz_store *store, const char *group, const char *dimension,
                         kz_listed *motions);
void kz_listed_free(kz_listed *motions);
/* Matches attractors of `dynamics` with a list: id [count + 1], from number 1 on; -1 = not in the list. */
void kz_listed_match(const kz_dynamics *dynamics, const kz_listed *list, int32_t *id);
