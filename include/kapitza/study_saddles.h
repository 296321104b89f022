/* study: all cycles of a pendulum on request (C; layer 3). No MPI, no files. */
#pragma once

#include "kapitza/study_catalogue.h"

/* All cycles of up to max_period periods, attracting or not, with a point in the window, as the study `saddles` finds
 * them. *open = number of index sums that are not 0. The caller frees the catalogue by kz_saddles_free. */
kz_status kz_saddles_all(const kz_scene *scene, int64_t max_period, const kz_window *window, kz_catalogue *all,
                         int64_t *open);
void kz_saddles_free(kz_catalogue *all);
