/* What the files of labelling share. */
#ifndef KAPITZA_STUDY_LABEL_PARTS_H
#define KAPITZA_STUDY_LABEL_PARTS_H

#include "common/cells.h"
#include "label.h"

enum { KZ_BATCH = 16384 }; /* cells that are followed together, at most */

kz_workspace *kz_workspace_make(void);

/* Labels n cells: cells [n], or first, first + 1, ... where that is NULL. KZ_STOPPED where a stop is asked. */
kz_status kz_label_cells(const kz_labelling *labelling, int64_t first, const int64_t *cells, int64_t n, kz_labelled *out);

/* Bytes of a packed tile at most. */
size_t kz_labels_room(const kz_labelling *labelling);
/* Packs the own cells of a tile, labelling->cell. */
kz_status kz_labels_pack(const kz_labelling *labelling, int64_t tile, void *record);
/* Unsettled cells of a packed tile. */
int64_t kz_labels_open(const kz_piece *piece);
/* Counts the attractors that it reaches. */
void kz_labels_note_reached(const kz_labelling *labelling, const kz_piece *piece);

/* Counts the unsettled cells of all tiles: labelling->before. Collective. */
kz_status kz_open_count(kz_labelling *labelling);
/* Numbers of n of the unsettled cells from .. from + of - 1, evenly chosen, in order: cell [n], on every rank. Collective. */
kz_status kz_open_pick(kz_labelling *labelling, int64_t from, int64_t of, int64_t n, int64_t *cell);
/* Labels the unsettled cells of all tiles once more, in stages `name`. Collective. */
kz_status kz_open_label(kz_labelling *labelling, const char *name);

#endif
