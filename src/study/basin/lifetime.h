/* How long the transients of a window last: from the cells of every few rows that are not mirror images. */
#ifndef KAPITZA_STUDY_LIFETIME_H
#define KAPITZA_STUDY_LIFETIME_H

#include <stdint.h>
#include <stdio.h>

#include "kapitza/analysis.h"
#include "kapitza/store.h"
#include "kapitza/study.h"

/* Settling times, periods, in any order; and the number of cells that have not settled. */
typedef struct {
  int64_t n, n_open;
  double *time;
} kz_transients;

/* Makes room for those of a window. Free with kz_transients_free. */
void kz_transients_make(const kz_basin_plan *plan, kz_transients *transients);
void kz_transients_free(kz_transients *transients);

/* Picks those of n consecutive cells, the first of which has the number `first`, that count. Returns how many; picked takes as many times
 * KZ_TRANSIENT_BYTES for kz_transients_add. label [n]: below 0 if the cell has not settled. */
enum { KZ_TRANSIENT_BYTES = sizeof(uint32_t) };
int64_t kz_transients_pick(const kz_basin_plan *plan, int64_t first, int64_t n, const int16_t *label, const uint32_t *periods,
                           void *picked);
void kz_transients_add(kz_transients *transients, int64_t n, const void *picked);

/* Writes and tells the mean of the slow ones; moves the times. Rank 0. */
kz_status kz_lifetime_write(const kz_basin_plan *plan, kz_transients *transients, kz_store *store, FILE *summary);

#endif
