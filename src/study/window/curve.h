/* The map stretches a small window along one direction and compresses it across. When its cells are handed over to doubles, a deep window has
 * become a curve, so samples along the curve give the labels of all cells. Not collective. */
#ifndef KAPITZA_STUDY_WINDOW_CURVE_H
#define KAPITZA_STUDY_WINDOW_CURVE_H

#include "starts.h"

typedef struct {
  const kz_hand_over *hand_over;
  double middle[2], along[2]; /* of the window, and the curve's direction (a unit vector): shares of the images' width */
  double step;                /* distance of neighbouring samples */
  int64_t count;              /* number of samples; 0 = the window is not a curve */
  int64_t columns;            /* of the window */
  double *column, *row;       /* column [j] + row [i] = place of cell (i, j), in steps from sample 0 */
} kz_window_curve;

/* Makes the curve with 16 samples a cell, so that a sample is at most 1/32 of a cell from the start of a cell; across the curve starts differ
 * by less than a tenth of that. The caller frees it. */
void kz_window_curve_make(const kz_window_starts *starts, kz_window_curve *curve);
void kz_window_curve_free(kz_window_curve *curve);

/* The sample nearest to a cell. */
int64_t kz_window_curve_sample(const kz_window_curve *curve, int64_t cell);
/* The state of a sample when it is handed over: state [2], half-turns and rad per drive radian, after *periods drive periods. */
void kz_window_curve_state(const kz_window_curve *curve, int64_t sample, double state[2], int64_t *periods);

#endif
