/* The cells of a basin's window as starts for a labeller, at any depth. Items are the numbers of cells, theta fastest. Not collective. */
#ifndef KAPITZA_STUDY_WINDOW_STARTS_H
#define KAPITZA_STUDY_WINDOW_STARTS_H

#include "images.h"
#include "labelling/labeller.h"

typedef struct {
  const kz_basin_plan *plan;
  const kz_pendulum *pendulum;
  kz_dynamics *dynamics;
  kz_images *images; /* this struct is a holder; NULL = the cells are doubles */
  kz_hand_over hand_over[KZ_LEVEL_ARBITRARY];
  __float128 *place[2]; /* with images: place of each column and of each row, in shares of the images' width */
  double *centre[2];    /* without images: centre of each column and of each row, rad and rad per drive radian */
} kz_window_starts;

/* Makes the starts from finished images that serve the window (kz_images_serve), or without images (NULL). The caller frees them. */
void kz_window_starts_make(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_dynamics *dynamics, kz_images *images,
                           kz_window_starts *starts);
void kz_window_starts_free(kz_window_starts *starts);

/* The labeller of the cells. decide = true: cells that quad precision does not decide are decided by their own orbits. */
kz_labeller kz_window_labeller(const kz_window_starts *starts, bool decide);

/* The state of a cell when it is handed over to doubles: state [2], half-turns and rad per drive radian, after *periods drive periods. */
void kz_window_state(const kz_window_starts *starts, int64_t cell, double state[2], int64_t *periods);

#endif
