/* Functions and constants that the files of labelling share. */
#ifndef KAPITZA_STUDY_LABEL_PARTS_H
#define KAPITZA_STUDY_LABEL_PARTS_H

#include "numerics/cells.h"
#include "label.h"
#include "labelling/labeller.h"

enum { KZ_BATCH = 16384 }; /* largest number of cells that are followed together */

kz_workspace *kz_workspace_make(void);

/* The labeller of cells, whose items are the numbers of cells. */
kz_labeller kz_cells_labeller(const kz_window_labels *labelling);
/* Labels n cells at the present level, out [n]: those in cells [n], or first, first + 1, ... if cells is NULL. KZ_STOPPED if a stop is
 * requested. */
kz_status kz_label_cells(kz_window_labels *labelling, int64_t first, const int64_t *cells, int64_t n, kz_cell_label *out);

/* Largest number of bytes of a packed tile. */
size_t kz_tile_labels_bytes(const kz_window_labels *labelling);
/* Packs the own cells of a tile, labelling->cell. */
kz_status kz_tile_labels_pack(const kz_window_labels *labelling, int64_t tile, void *record);
/* The same, but the packed tile replaces the contents of `kept`, a record of this rank; `record` is a buffer for a packed tile. */
kz_status kz_tile_labels_replace(const kz_window_labels *labelling, kz_local_record *kept, void *record);
/* Number of cells of a packed tile with the label `wanted`, 0 or KZ_DOUBTFUL. */
int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted);
/* Adds the tile to labelling->reached of every attractor that one of its cells ends on. */
void kz_tile_labels_note_reached(const kz_window_labels *labelling, const kz_local_record *kept);

/* The name of a level's stages; the first level's stages are those of all cells. */
const char *kz_level_name(int level);
/* The value of `evidence` for labels that a level decides; KZ_LEVELS: for labels that no level decides. */
uint8_t kz_level_evidence(int level);
/* How many pending cells of the level before a level takes at a time. */
int64_t kz_level_tile(int level);

/* Counts the cells of all tiles with the label `wanted` into labelling->before; these cells are now pending. Collective. */
kz_status kz_pending_count(kz_window_labels *labelling, int16_t wanted);
/* cell [n] = the numbers of n evenly chosen cells among the pending cells from .. from + of - 1, in order, on every rank. Collective. */
kz_status kz_pending_pick(kz_window_labels *labelling, int64_t from, int64_t of, int64_t n, int64_t *cell);
/* Labels the pending cells of all tiles, from `level` on, until each is decided or no level is left, in stages of round `round`.
 * Collective. */
kz_status kz_pending_label(kz_window_labels *labelling, int level, int round);

#endif
