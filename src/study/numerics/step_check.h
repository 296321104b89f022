/* Whether the steps are fine enough for the motions of a study, tested before anything is labelled: step doubling on a
 * sample of every class of speeds. And whether a map table is fine enough for its cells. Not collective. */
#pragma once

#include "kapitza/study.h"
#include "steps.h"

/* Motions of one study: their numerics, the errors that are allowed, the keys that a user could change. */
typedef struct {
  kz_pendulum pendulum;
  kz_numerics numerics;
  double fastest;                  /* start, rad per drive radian */
  double warn_above, refuse_above; /* rad, of one drive period: warned of above, refused above */
  double cell;                     /* rad; INFINITY where nothing has cells */
  const char *keys;                /* "KEY|KEY" */
  char where[208];                 /* "at m = 0.3, ", or "" */
} kz_step_motions;

/* Motions with the scene's pendulum and numerics from starts up to speed `fastest` (rad per drive radian). */
kz_step_motions kz_motions_of(const kz_scene *scene, double fastest, const char *keys);
/* Checks motions that label the cells of a basin: the allowed errors are shares of a cell where that is less. */
void kz_motions_label_cells(const kz_basin_plan *plan, kz_step_motions *motions);

/* rad: what one drive period of a basin's window may be off by without a warning: a hundredth of a cell (kz_cell_size),
 * 1e-4 at most. */
double kz_steps_tolerance(const kz_basin_plan *plan);

/* Steps that leave nothing to warn of; where rounding forbids that in small cells, steps that are not refused. False
 * where no number of steps does: then *numerics has the largest number tried. */
bool kz_motions_find_steps(const kz_step_motions *motions, kz_numerics *numerics);

/* KZ_REFUSED where one drive period is off by more than `refuse_above`: the message begins with `keys`, and says at
 * which speeds, and how many steps would do. */
kz_status kz_motions_check(const kz_step_motions *motions);
/* The errors of all classes of speeds. */
kz_speed_errors kz_motions_errors(const kz_step_motions *motions);
/* A line for each class of speeds whose error exceeds `warn_above`, and what would help. */
void kz_motions_warn(const kz_step_motions *motions, const kz_speed_errors *classes, FILE *summary);

/* KZ_REFUSED if `table_error`, the error of one period by the map table (rad), exceeds a cell; the message gives a
 * number of nodes that is enough. */
kz_status kz_steps_check_table(const kz_basin_plan *plan, double table_error);
/* Prints a warning if it exceeds kz_steps_tolerance. */
void kz_steps_warn_table(const kz_basin_plan *plan, double table_error, FILE *summary);
