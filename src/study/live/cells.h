/* Cells of one frame, followed where they are pending. */
#ifndef KAPITZA_STUDY_LIVE_CELLS_H
#define KAPITZA_STUDY_LIVE_CELLS_H

#include "resident.h"
#include "window/curve.h"

/* What is known of a cell. */
enum { KZ_CELL_PENDING = 0, KZ_CELL_FOLLOWED = 1, KZ_CELL_DECIDED = 2, KZ_CELL_UNDECIDED = 3 };
typedef struct {
  int16_t label; /* number of kz_dynamics, 0 = not settled */
  int16_t other; /* of an undecided cell: the second candidate, 0 = none */
  float periods;
  uint8_t state;
} kz_frame_cell;

/* Cells that are followed at a time. */
enum { KZ_FRAME_TILE = 1024 };

/* The starts of a frame's cells: at any depth, with the images of the last frame where these serve. To be freed where it is KZ_OK. */
kz_status kz_cells_begin(kz_resident *resident, const kz_basin_plan *plan, const kz_frame *frame, kz_window_starts *starts);

/* Follows n <= KZ_FRAME_TILE cells (their numbers, theta fastest). */
kz_status kz_cells_follow(kz_resident *resident, const kz_window_starts *starts, int64_t n, const int64_t *number,
                          kz_frame_cell *cells);

/* The cells of a moving frame whose window is a curve, by samples along it. */
typedef struct {
  kz_window_curve curve;
  kz_frame_cell *cell; /* [curve.count] of each sample */
  int64_t *wanted;     /* [curve.count] those that are to be followed */
} kz_samples;

/* To be freed. curve.count is 0 where the window is no curve. */
void kz_samples_make(const kz_window_starts *starts, kz_samples *samples);
void kz_samples_free(kz_samples *samples);

/* Follows n cells, any number, as their samples. */
kz_status kz_samples_follow(kz_resident *resident, const kz_frame *frame, kz_samples *samples, int64_t n, const int64_t *number,
                            kz_frame_cell *cells);

/* Looks for attractors that up to n of these cells end on, which have not settled. *born: some have joined. */
kz_status kz_cells_discover(kz_resident *resident, const kz_window_starts *starts, int64_t n, const int64_t *number,
                            bool *born);

#endif
