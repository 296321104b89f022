/* Other processes that follow a frame's cells beside this one. */
#ifndef KAPITZA_STUDY_LIVE_CREW_H
#define KAPITZA_STUDY_LIVE_CREW_H

#include "cells.h"

/* What this process and its helpers share: the cells of a frame and how far they are. */
typedef struct kz_crew kz_crew;

/* For a frame of `total` cells, all pending; to be freed by kz_crew_free. `helpers`: beside this process, 0 = none. */
kz_crew *kz_crew_create(int64_t total, int helpers);
void kz_crew_free(kz_crew *crew);

/* [total] */
kz_frame_cell *kz_crew_cells(kz_crew *crew);

/* As many helpers as this process may use further cores. */
int kz_spare_cores(void);

/* Follows n cells, tile by tile, whoever is free the next one. Their labels do not depend on who follows them. */
kz_status kz_crew_follow(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts, int64_t n,
                         const int64_t *number);

#endif
