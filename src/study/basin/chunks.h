/* Writes the labels of a window into the file, chunk by chunk, and counts them. */
#ifndef KAPITZA_STUDY_CHUNKS_H
#define KAPITZA_STUDY_CHUNKS_H

#include "attractors/catalogue.h"
#include "label.h"
#include "lifetime.h"
#include "measures.h"

typedef struct {
  kz_window_labels *labelling;
  kz_catalogue *catalogue; /* out: its fractions */
  kz_store *store;         /* NULL on all ranks but rank 0 */
  int64_t n_sample;
  const int64_t *sample;     /* [n_sample] cells whose labels the caller needs */
  int64_t *sample_label;     /* [n_sample] in: 0; out: numbers of kz_dynamics */
  kz_counts counts;          /* in: 0; out: of all cells */
  kz_transients *transients; /* in: none; out: of all cells, on rank 0 */
  int16_t *ids;              /* one tile; this and the next three are buffers */
  uint32_t *periods;
  uint8_t *evidence;
  int16_t *others;   /* second candidates */
  int64_t *cells_of; /* [attractors] number of cells */
} kz_chunks;

/* Declares the variables of the cells; their dimensions must exist. Rank 0. */
kz_status kz_chunks_declare(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store);
/* Writes all labels and counts them; it uses the last five fields for itself. Collective. */
kz_status kz_cells_write(kz_chunks *chunks);
/* Writes all cells as not settled. Rank 0. */
kz_status kz_chunks_write_unsettled(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store);

#endif
