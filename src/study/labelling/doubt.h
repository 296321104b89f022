/* How many labels of a basin its numerics do not decide: of all cells that are integrated, and of a map table's by a random sample of
 * cells, each integrated with the error of its orbit. */
#ifndef KAPITZA_STUDY_DOUBT_H
#define KAPITZA_STUDY_DOUBT_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "numerics/share.h"

typedef struct {
  int64_t cells;      /* that were asked about; 0 = none */
  kz_share doubtful;  /* share whose label steps and rounding may change */
  kz_share differing; /* share with another label than a decided one: errors of the map table */
} kz_doubt;

/* Cells of the sample; none but for method icm, since the others ask about all cells. */
int64_t kz_doubt_cells(const kz_basin_plan *plan);
/* Cell i of the sample, one of the kz_unique_cells: a function of the window, its cells and the seed alone. */
int64_t kz_doubt_cell(const kz_basin_plan *plan, int64_t i);

/* Follows the sample; followed [kz_doubt_cells, rounded up to KZ_DOUBT_TILE] is filled on rank 0, NULL elsewhere. Its stage is kept by
 * a checkpoint. Collective. */
enum { KZ_DOUBT_TILE = 256 };
kz_status kz_doubt_follow(const kz_basin_plan *plan, const kz_run *run, kz_dynamics *dynamics, int32_t *followed);
/* What the sample takes, seconds of processor time from a part of it, is added to *seconds. Not collective. */
kz_status kz_doubt_measure(const kz_basin_plan *plan, kz_dynamics *dynamics, double *seconds);
/* What is told of n cells, all of them. */
kz_doubt kz_doubt_of_all(int64_t doubtful, int64_t n);
/* What the sample tells about the labels of the sample's cells: numbers of the same dynamics. */
kz_doubt kz_doubt_count(const kz_basin_plan *plan, const int32_t *followed, const int64_t *label);

/* Attributes of /basin, and what people read of them. Rank 0. */
kz_status kz_doubt_write(const kz_doubt *doubt, int32_t method, kz_store *store, FILE *summary);

#endif
