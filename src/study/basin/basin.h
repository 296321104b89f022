/* The study `basin` and its parts: cells in the file, measures of them, transients. */
#pragma once

#include "labelling/catalogue.h"
#include "label.h"
#include "doubt.h"

enum { KZ_TILE_CELLS = 16384 }; /* cells of a tile, about: enough to keep all lanes busy while a few cells take long */

/* ---- transients: how long they last, from the cells of every few rows that are not mirror images ---- */

/* Settling times, periods, in any order; KZ_NOT_ENDED: the cell has not settled. */
typedef struct {
  int64_t n;
  uint32_t *time;
} kz_transients;

/* An empty list with memory for those of a window. The caller frees `time`. */
kz_transients kz_transients_make(const kz_basin_plan *plan);
/* Picks those of n consecutive cells, the first of which has the number `first`, that count. Returns how many; picked
 * takes as many times KZ_TRANSIENT_BYTES for kz_transients_add. label [n]: below 0 if the cell has not settled. */
enum { KZ_TRANSIENT_BYTES = sizeof(uint32_t) };
int64_t kz_transients_pick(const kz_basin_plan *plan, int64_t first, int64_t n, const int16_t *label,
                           const uint32_t *periods, void *picked);
void kz_transients_add(kz_transients *transients, int64_t n, const void *picked);

/* Writes and prints the mean of the slow ones; moves the times. Rank 0. */
kz_status kz_lifetime_write(const kz_basin_plan *plan, kz_transients *transients, kz_store *store, FILE *summary);

/* ---- the cells in the file, chunk by chunk ---- */

struct kz_chunks {
  kz_window_labels *labelling;
  kz_catalogue *catalogue;   /* out: its fractions */
  kz_store *store;           /* NULL on all ranks but rank 0 */
  kz_doubt_sample *sample;   /* out: its labels; NULL = none */
  kz_counts counts;          /* in: 0; out: of all cells */
  kz_transients *transients; /* in: none; out: of all cells, on rank 0; NULL: not needed */
  int16_t *ids;              /* one tile; this and the next four are buffers */
  uint32_t *periods;
  uint8_t *evidence;
  int16_t *others; /* second candidates */
  int32_t *turns;
  int64_t *cells_of; /* [attractors] number of cells */
};

/* Declares the variables of the cells; their dimensions must exist. Rank 0. */
kz_status kz_chunks_declare(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store);
/* Writes all labels and counts them; it uses the last six fields for itself. Collective. */
kz_status kz_cells_write(kz_chunks *chunks);

/* ---- everything else in the file and the summary ---- */

/* Totals of a labelled window. */
typedef struct {
  int64_t cells;
  kz_counts counts;
  double trapped_share; /* share of the cells of the trapping regions' grid that are trapped */
  double step_error;    /* rad: the largest error of one drive period in a sample */
  kz_doubt doubt;       /* Doubt about the labels */
  const char *advice;   /* Advice about cells that stay undecided */
  double table_error;   /* rad: the same of the map table; NaN without a table */
} kz_window_summary;

/* Declares axes and variables of group /basin, before the cells are written. */
kz_status kz_basin_declare(const kz_scene *scene, const kz_tiles *tiles, kz_store *store);
/* Writes group /attractors, the attributes of /basin, and the summary. */
kz_status kz_basin_write(const kz_scene *scene, const kz_catalogue *catalogue, const kz_window_summary *labels,
                         kz_store *store, FILE *summary);
