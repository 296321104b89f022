/* The images of a window, made by one rank and shared with all. */
#ifndef KAPITZA_STUDY_REFERENCE_H
#define KAPITZA_STUDY_REFERENCE_H

#include "images.h"
#include "kapitza/parallel.h"

/* Follows the window's centre until the images are finished, in stages that a checkpoint keeps. Every rank gets the same images. Collective. */
kz_status kz_images_run(const kz_run *run, kz_dynamics *dynamics, kz_images *images, int64_t max_periods);

#endif
