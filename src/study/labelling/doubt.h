/* The number of doubtful labels of a basin. If cells are integrated, it is counted over all of them. For labels by a map table it is
 * estimated from a random sample of cells, each integrated with the error of its orbit. */
#ifndef KAPITZA_STUDY_DOUBT_H
#define KAPITZA_STUDY_DOUBT_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "numerics/share.h"

typedef struct {
  int64_t cells;      /* number of cells considered; 0 = none */
  kz_share doubtful;  /* share of labels that steps and rounding may change */
  kz_share differing; /* share of labels that differ from a decided label: errors of the map table */
} kz_doubt;

/* Number of cells of the sample; 0 for all methods but icm, which consider all cells. */
int64_t kz_doubt_cells(const kz_basin_plan *plan);
/* Cell i of the sample, one of the kz_unique_cells. It depends on the window, its cells and the seed only. */
int64_t kz_doubt_cell(const kz_basin_plan *plan, int64_t i);

/* Follows the sample; followed [kz_doubt_cells, rounded up to KZ_DOUBT_TILE] is filled on rank 0, NULL elsewhere. Its stage is kept by
 * a checkpoint. Collective. */
enum { KZ_DOUBT_TILE = 256 };
kz_status kz_doubt_follow(const kz_basin_plan *plan, const kz_run *run, kz_dynamics *dynamics, int32_t *followed);
/* Estimates the processor time of the sample from a part of it and adds it to *seconds. Not collective. */
kz_status kz_doubt_measure(const kz_basin_plan *plan, kz_dynamics *dynamics, double *seconds);
/* The result if `doubtful` of n cells, which are all cells, are doubtful. */
kz_doubt kz_doubt_of_all(int64_t doubtful, int64_t n);
/* The result from the sample: `followed` against the labels of the sample's cells, both numbers of the same dynamics. */
kz_doubt kz_doubt_count(const kz_basin_plan *plan, const int32_t *followed, const int64_t *label);

/* Writes the attributes of /basin and the lines of the summary. Rank 0. */
kz_status kz_doubt_write(const kz_doubt *doubt, int32_t method, kz_store *store, FILE *summary);

#endif
