/* The number of doubtful labels of a basin. If cells are integrated, it is counted over all of them. For labels by a
 * map table it is estimated from a random sample of cells, each integrated with the error of its orbit. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "numerics/share.h"

typedef struct {
  int64_t cells;      /* number of cells considered; 0 = none */
  kz_share doubtful;  /* share of labels that steps and rounding may change */
  kz_share differing; /* share of labels that differ from a decided label: errors of the map table */
} kz_doubt;

/* A sample of cells, for method icm. */
typedef struct {
  int64_t n, *cell, *label; /* [n] cells, and their labels, which the caller fills in: numbers of kz_dynamics */
  int32_t *followed;        /* [n] on rank 0: the same by integration, or KZ_DOUBTFUL */
} kz_doubt_sample;

/* Draws and follows the sample in a kept stage, where the method needs one. kz_doubt_free in any case. Collective. */
kz_status kz_doubt_follow(const kz_basin_plan *plan, const kz_run *run, kz_dynamics *dynamics, kz_doubt_sample *sample);
void kz_doubt_free(kz_doubt_sample *sample);
/* The result: from the sample, or without one, if `doubtful` of all cells are doubtful. Rank 0. */
kz_doubt kz_doubt_of(const kz_basin_plan *plan, const kz_doubt_sample *sample, int64_t doubtful);

/* Writes the attributes of /basin and the lines of the summary. Rank 0. */
kz_status kz_doubt_write(const kz_doubt *doubt, int32_t method, kz_store *store, FILE *summary);
