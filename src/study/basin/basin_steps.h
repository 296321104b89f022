/* The steps of a basin: chosen, checked and reported beside its cells. Not collective. */
#ifndef KAPITZA_STUDY_BASIN_STEPS_H
#define KAPITZA_STUDY_BASIN_STEPS_H

#include "kapitza/study.h"

/* The steps of a basin and their error beside its cells, and a line for each class of speeds that is off by more than
 * kz_steps_tolerance. Returns the largest error of a drive period, rad: an upper estimate. */
double kz_basin_warn_steps(const kz_scene *scene, FILE *summary);

#endif
