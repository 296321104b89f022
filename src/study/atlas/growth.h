/* The run: seeds that wait, curves that come of them, the census of random places. */
#pragma once

#include "types.h"

/* Traces and explores every curve that comes of the seeds that wait, until nothing is left. Collective. */
kz_status kz_atlas_drain(kz_atlas *atlas, const kz_run *run);
/* Follows all branches along n columns, and traces and explores the curves that come of them. Collective. */
kz_status kz_atlas_explore_columns(kz_atlas *atlas, const kz_run *run, int64_t n, const double *x);
/* A seed waits to be traced unless it lies on a known curve. */
void kz_atlas_await(kz_atlas *atlas, const kz_cycle *seed);
/* Runs all stages. Collective. */
kz_status kz_atlas_search(kz_atlas *atlas, const kz_run *run);

/* Finds all cycles of n places, beside those found there, follows each to the first curve that it meets, and traces and
 * explores the curves that come of them. *wide: how many new curves have a band of 1e-4 sides or more; NULL: the places
 * are not random, and count for no estimate. Collective. */
kz_status kz_atlas_census(kz_atlas *atlas, const kz_run *run, int64_t n, const kz_atlas_probe *probe, int64_t *wide);
/* How many places of the census see each curve: places [n_curves]. */
void kz_atlas_count_sightings(const kz_atlas *atlas, int64_t *places);

/* Writes how many curves are missing, as the census tells. */
kz_status kz_atlas_write_tally(const kz_atlas *atlas, kz_store *store, FILE *summary);
