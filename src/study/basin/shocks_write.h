/* Writes the smallest shocks of a basin to its file. */
#ifndef KAPITZA_STUDY_SHOCKS_WRITE_H
#define KAPITZA_STUDY_SHOCKS_WRITE_H

#include <stdio.h>

#include "attractors/catalogue.h"
#include "resilience/resilience.h"

/* Writes group /shocks, and prints the smallest shocks of each attractor to the summary. Rank 0. */
kz_status kz_shocks_write(const kz_resilience_plan *plan, const kz_catalogue *catalogue, int64_t n, const kz_resilience *point,
                          kz_store *store, FILE *summary);

#endif
