/* What the files of labelling share. */
#ifndef KAPITZA_STUDY_LABEL_PARTS_H
#define KAPITZA_STUDY_LABEL_PARTS_H

#include "numerics/cells.h"
#include "label.h"
#include "labelling/labeller.h"

enum { KZ_BATCH = 16384 }; /* cells that are followed together, at most */

kz_workspace *kz_workspace_make(void);

/* The labeller of cells: items are their numbers. */
kz_labeller kz_cells_labeller(const kz_window_labels *labelling);
/* Labels n cells at the present level: cells [n], or first, first + 1, ... where that is NULL. KZ_STOPPED where a stop is asked. */
kz_status kz_label_cells(kz_window_labels *labelling, int64_t first, const int64_t *cells, int64_t n, kz_cell_label *out);

/* Bytes of a packed tile at most. */
size_t kz_tile_labels_bytes(const kz_window_labels *labelling);
/* Packs the own cells of a tile, labelling->cell. */
kz_status kz_tile_labels_pack(const kz_window_labels *labelling, int64_t tile, void *record);
/* The same into a record of this rank, in place of what it had; record: a buffer for a packed tile. */
kz_status kz_tile_labels_replace(const kz_window_labels *labelling, kz_local_record *kept, void *record);
/* Cells of a packed tile with the label `wanted`, 0 or KZ_DOUBTFUL. */
int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted);
/* Counts the attractors that it reaches. */
void kz_tile_labels_note_reached(const kz_window_labels *labelling, const kz_local_record *kept);

/* What a level writes into the file as evidence, KZ_LEVELS: of what none decides; and how many cells it takes at a time, where it takes
 * those that another one left. */
const char *kz_level_name(int level); /* of its stages; the first one's are those of all cells */
uint8_t kz_level_evidence(int level);
int64_t kz_level_tile(int level);

/* Counts the cells of all tiles with the label `wanted`, which are pending then: labelling->before. Collective. */
kz_status kz_pending_count(kz_window_labels *labelling, int16_t wanted);
/* Numbers of n of the pending cells from .. from + of - 1, evenly chosen, in order: cell [n], on every rank. Collective. */
kz_status kz_pending_pick(kz_window_labels *labelling, int64_t from, int64_t of, int64_t n, int64_t *cell);
/* Labels the pending cells of all tiles from a level on, until each is decided or no level decides it, in stages of round `round`.
 * Collective. */
kz_status kz_pending_label(kz_window_labels *labelling, int level, int round);

#endif
