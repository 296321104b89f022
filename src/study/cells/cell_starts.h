/* The cells of a window as starts for a labeller; items are the numbers of cells, theta fastest. */
#pragma once

#include "kapitza/study_basin.h"
#include "labelling/labeller.h"

typedef struct {
  const kz_basin_plan *plan;
  double *centre[2]; /* Centres of the columns (rad) and of the rows (rad per drive radian) */
} kz_cell_starts;

/* The caller frees them. */
void kz_cell_starts_make(const kz_basin_plan *plan, kz_cell_starts *starts);
void kz_cell_starts_free(kz_cell_starts *starts);
/* A kz_start_fn, whose context they are. */
kz_status kz_cell_starts_at(void *starts, int64_t cell, kz_precision level, kz_start *start);
/* The labeller of the cells, by levels. */
kz_labeller kz_cell_starts_labeller(const kz_cell_starts *starts, kz_dynamics *dynamics);
/* Makes starts with centres that are computed anew for each. */
kz_labeller kz_cell_labeller(const kz_basin_plan *plan, kz_dynamics *dynamics);
/* The way of a method. */
kz_way kz_way_of(kz_method method);
/* How kz_dynamics_follow moves starts by a method. */
kz_stepper kz_stepper_of(kz_method method, kz_interpolation interpolation);
