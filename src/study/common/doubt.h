/* How many labels of a basin its numerics do not decide: a random sample of cells, each integrated again with the error of its
 * orbit. */
#ifndef KAPITZA_STUDY_DOUBT_H
#define KAPITZA_STUDY_DOUBT_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "share.h"

typedef struct {
  int64_t cells;      /* of the sample; 0 = nothing was asked */
  kz_share doubtful;  /* share whose label steps and rounding may change */
  kz_share differing; /* share with another label than a decided one: errors of the map table */
} kz_doubt;

/* Cells of the sample. */
int64_t kz_doubt_cells(const kz_basin_plan *plan);

/* Follows the sample, which depends on the window, its cells and the seed alone. label [kz_own_cells] on rank 0: the labels, as
 * numbers of `dynamics`. `doubt` is filled on rank 0. Its stage is kept by a checkpoint. Collective. */
kz_status kz_doubt_measure(const kz_basin_plan *plan, kz_ranks *ranks, kz_dynamics *dynamics, const int16_t *label,
                           kz_doubt *doubt);

/* Attributes of /basin, and what people read of them. Rank 0. */
kz_status kz_doubt_write(const kz_doubt *doubt, bool with_table, kz_store *store, FILE *summary);

#endif
