/* The labels of a window on their way into the file, chunk by chunk, and what is counted on the way. */
#ifndef KAPITZA_STUDY_CHUNKS_H
#define KAPITZA_STUDY_CHUNKS_H

#include "attractors/catalogue.h"
#include "label.h"
#include "measures.h"

typedef struct {
  kz_window_labels *labelling;
  kz_catalogue *catalogue; /* fractions are filled in */
  kz_store *store;         /* NULL but on rank 0 */
  int64_t n_sample;
  const int64_t *sample; /* [n_sample] own cells whose labels are wanted */
  int64_t *sample_label; /* [n_sample] in: 0; out: numbers of kz_dynamics */
  kz_counts counts;      /* in: 0; out: of all cells */
  int16_t *ids;          /* a tile */
  uint32_t *periods;
  uint8_t *evidence;
  int16_t *others;   /* second candidates */
  int64_t *cells_of; /* [attractors] cells */
} kz_chunks;

/* Declares the variables of the cells, whose dimensions are there. Rank 0. */
kz_status kz_chunks_declare(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store);
/* Writes all labels and counts them; the last five fields are its own. Collective. */
kz_status kz_cells_write(kz_chunks *chunks);
/* Writes cells that have not settled in `periods`. Rank 0. */
kz_status kz_chunks_write_unsettled(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store);

#endif
