/* step_check: whether the steps are fine enough for a scene, tested before anything is labelled (C; layer 3, study). Not
 * collective. */
#ifndef KAPITZA_STUDY_STEP_CHECK_H
#define KAPITZA_STUDY_STEP_CHECK_H

#include "kapitza/study.h"

/* rad: what one drive period of a basin's window may be off by without a word: a hundredth of a cell (kz_cell_size), 1e-4 at
 * most. */
double kz_steps_tolerance(const kz_basin_plan *plan);

/* Doubles the steps until every class is right to `tolerance` (rad); false where that does not help, or takes more than
 * `most` steps: then the last number tried. */
bool kz_steps_enough(const kz_pendulum *pendulum, double fastest, double tolerance, int32_t most, kz_numerics *numerics);

/* False where the error of one drive period exceeds 0.1 rad or the motion diverges: labels would be random. */
bool kz_steps_carry(const kz_pendulum *pendulum, const kz_numerics *numerics, double fastest);

/* A line for each class of speeds up to `fastest` that is off by more than 1e-4 rad. */
void kz_steps_warn(const kz_scene *scene, double fastest, FILE *summary);
/* The steps of a basin and their error beside its cells, and a line for each class of speeds that is off by more than
 * kz_steps_tolerance. Returns the largest error of a drive period, rad: an upper estimate. */
double kz_steps_warn_basin(const kz_scene *scene, FILE *summary);
/* The same for the worst of a sweep's values. */
void kz_steps_warn_sweep(const kz_scene *scene, FILE *summary);

/* KZ_REFUSED where one period of the map table (`defect`, rad) is off by more than a cell: the message tells the nodes that
 * would do. */
kz_status kz_steps_check_table(const kz_basin_plan *plan, double defect);
/* A line where it is off by more than kz_steps_tolerance. */
void kz_steps_warn_table(const kz_basin_plan *plan, double defect, FILE *summary);

#endif
