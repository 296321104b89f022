/* The map stretches a small window along one direction and presses it together across. Where its cells are handed over to doubles, a deep
 * window is a curve: samples along it tell where all cells go. Not collective. */
#ifndef KAPITZA_STUDY_WINDOW_CURVE_H
#define KAPITZA_STUDY_WINDOW_CURVE_H

#include "starts.h"

typedef struct {
  const kz_hand_over *hand_over;
  double middle[2], along[2]; /* of the window, and the curve's direction (a unit vector): shares of the images' width */
  double step;                /* from one sample to the next, along it */
  int64_t count;              /* samples; 0: the window is no curve */
  int64_t columns;            /* of the window */
  double *column, *row;       /* of a cell: their sum is its place in steps from sample 0 */
} kz_window_curve;

/* Sixteen samples a cell, so that a cell's start moves by a thirty-second of a cell at most; along the curve's width the starts differ by less
 * than a tenth of that. To be freed. */
void kz_window_curve_make(const kz_window_starts *starts, kz_window_curve *curve);
void kz_window_curve_free(kz_window_curve *curve);

/* The sample nearest to a cell. */
int64_t kz_window_curve_sample(const kz_window_curve *curve, int64_t cell);
/* Where a sample is when it is handed over: half-turns, rad per drive radian; *periods that it has spent then. */
void kz_window_curve_state(const kz_window_curve *curve, int64_t sample, double state[2], int64_t *periods);

#endif
