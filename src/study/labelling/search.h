/* Discovery of the attractors that a set of starts ends on; shared by the studies that need a catalogue. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* A search: its starts, the trapping regions and the map table. */
typedef struct {
  kz_window window;
  int64_t starts, seed, max_periods;
  int64_t sought;                      /* starts from which a round looks for cycles, at most; 0 = 1024 */
  int64_t cells;                       /* cells to label later: more cells get a finer grid of trapping regions */
  int64_t table_theta, table_velocity; /* nodes of the map table; 0 = none */
  double max_velocity;                 /* for the regions and the table; 0 = kz_dynamics_max_velocity of the window */
} kz_search;

/* Finds the attractors that the starts end on. If regions are grown, a few starts come first: regions grow around the
 * attractors of most of the window, and the other starts then settle soon. label [starts] as in kz_discover; NULL = not
 * needed. */
kz_status kz_search_window(const kz_run *run, kz_dynamics *dynamics, const kz_search *prepared_search,
                           int32_t *engine_label);

/* Cells along an axis of the regions' grid that pays if `cells` cells are labelled; 0 = none pays. */
int64_t kz_regions_cells(int64_t cells);
/* Grows regions around known attractors on that grid, or a finer one if hardly any grow; needs a grid. */
void kz_regions_grow(kz_dynamics *dynamics, int64_t cells, double max_velocity);

/* Follows n starts (state [n][2], half-turns and velocity; in and out) up to about max_periods periods, and finds the
 * attractors they end on; those join the catalogue and the regions (coarse or fine) of `dynamics` on every rank. label
 * [n] = attractor from 1, 0 where the start has not settled on any; NULL = cycles alone are looked for. sought: as in
 * kz_search. Collective; `run` NULL = this rank alone. */
kz_status kz_discover(const kz_run *run, kz_dynamics *dynamics, int64_t sought, int64_t max_periods, int64_t n,
                      double *state, int32_t *frame_label);

/* Builds the table of n_theta x n_velocity nodes up to velocity `max_velocity` on every rank. Collective; `run` NULL =
 * this rank alone. */
kz_status kz_map_table_make(const kz_run *run, kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity,
                            double max_velocity);
