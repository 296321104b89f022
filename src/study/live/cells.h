/* Cells of one frame, followed where they are pending. */
#ifndef KAPITZA_STUDY_LIVE_CELLS_H
#define KAPITZA_STUDY_LIVE_CELLS_H

#include "resident.h"
#include "window/curve.h"

/* State of a cell of a frame. */
enum { KZ_CELL_PENDING = 0, KZ_CELL_FOLLOWED = 1, KZ_CELL_DECIDED = 2, KZ_CELL_UNDECIDED = 3 };
typedef struct {
  int16_t label;         /* number of kz_dynamics, 0 = not settled */
  int16_t other;         /* of an undecided cell: the second candidate, 0 = none */
  float periods, smooth; /* settling times: whole, and smooth where the resident is asked for it */
  uint8_t state;
} kz_frame_cell;

/* Largest number of cells that are followed together. */
enum { KZ_FRAME_TILE = 2048 };

/* Cells of a moving frame on their way: where they are (half-turns, rad per drive radian), and the periods that they have spent. */
typedef struct {
  int64_t n, number[2 * KZ_FRAME_TILE], spent[2 * KZ_FRAME_TILE];
  double state[4 * KZ_FRAME_TILE];
} kz_travellers;

/* Makes the starts of a frame's cells, at any depth; it reuses the images of the last frame if possible. The caller frees them if the status
 * is KZ_OK. */
kz_status kz_cells_begin(kz_resident *resident, const kz_basin_plan *plan, const kz_frame *frame, kz_window_starts *starts);

/* Follows n <= KZ_FRAME_TILE cells; number [n] = their numbers in the frame, theta fastest. Those of a moving frame that take long join `late`,
 * which holds none at first: a few slow cells would leave most lanes empty. kz_cells_finish follows them to their ends. */
kz_status kz_cells_follow(kz_resident *resident, const kz_window_starts *starts, int64_t n, const int64_t *number,
                          kz_travellers *late, kz_frame_cell *cells);
void kz_cells_finish(kz_resident *resident, kz_travellers *late, kz_frame_cell *cells);

/* Samples along the curve that a deep window becomes: they label the cells of a moving frame. */
typedef struct {
  kz_window_curve curve;
  kz_frame_cell *cell; /* [curve.count] result of each sample */
  int64_t *wanted;     /* [curve.count] numbers of the samples to follow */
} kz_samples;

/* The caller frees *samples. curve.count is 0 if the window is not a curve. */
void kz_samples_make(const kz_window_starts *starts, kz_samples *samples);
void kz_samples_free(kz_samples *samples);

/* Follows any number n of cells by following their samples. */
kz_status kz_samples_follow(kz_resident *resident, const kz_frame *frame, kz_samples *samples, int64_t n, const int64_t *number,
                            kz_frame_cell *cells);

/* Looks for attractors from up to n of these cells, which have not settled. *born = true if it has found some. */
kz_status kz_cells_discover(kz_resident *resident, const kz_window_starts *starts, int64_t n, const int64_t *number,
                            bool *born);

#endif
