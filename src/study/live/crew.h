/* Helpers: other processes that follow cells of a frame together with this one. */
#ifndef KAPITZA_STUDY_LIVE_CREW_H
#define KAPITZA_STUDY_LIVE_CREW_H

#include "cells.h"

/* The memory that this process and its helpers share: the cells of a frame and their progress. */
typedef struct kz_crew kz_crew;

/* Makes a crew for a frame of `total` cells, all pending, with `helpers` further processes (0 = none). Free with kz_crew_free. */
kz_crew *kz_crew_create(int64_t total, int helpers);
void kz_crew_free(kz_crew *crew);

/* The cells of the frame, [total]. */
kz_frame_cell *kz_crew_cells(kz_crew *crew);

/* Number of further cores that this process may use. */
int kz_spare_cores(void);

/* Follows n cells in tiles; each process takes the next tile when it is free. The labels do not depend on which process follows a cell. */
kz_status kz_crew_follow(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts, int64_t n,
                         const int64_t *number);

#endif
