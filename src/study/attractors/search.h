/* Discovery of the attractors that a set of starts ends on; shared by the studies that need a catalogue. */
#ifndef KAPITZA_STUDY_SEARCH_H
#define KAPITZA_STUDY_SEARCH_H

#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/parallel.h"
#include "kapitza/study.h"

/* Starts spread over a window, the trapping regions and the map table of its dynamics. */
typedef struct {
  kz_window window;
  int64_t starts, seed, max_periods;
  int64_t cells;                       /* that are to be labelled: as finely do trapping regions grow */
  int64_t table_theta, table_velocity; /* nodes; 0 = no table is made */
  double max_velocity;                 /* of kz_dynamics_max_velocity */
} kz_search;

/* Finds the attractors that the starts end on. Where regions grow, the first starts are pilots: the regions grow around
 * the attractors of most of the window, and the other starts settle soon. state [starts][2], label [starts] as of kz_discover. */
kz_status kz_search_window(const kz_run *run, kz_dynamics *dynamics, const kz_search *search, double *state, int32_t *label);

/* Cells along an axis of a grid of trapping regions that pays back where so many cells are to be labelled; 0 = none does. */
int64_t kz_regions_cells(int64_t cells);
/* Grows the regions on that grid, where there is one, around the attractors that are known; on a finer one where hardly anything grows. */
void kz_regions_grow(kz_dynamics *dynamics, int64_t cells, double max_velocity);

/* Follows n starts (state [n][2], half-turns and velocity; in and out) up to about max_periods periods, and finds the attractors
 * they end on; those join the catalogue and the regions (coarse or fine) of `dynamics` on every rank. label [n] =
 * attractor from 1, 0 where the start has not settled on any. Collective; `run` NULL = this rank alone. */
kz_status kz_discover(const kz_run *run, kz_dynamics *dynamics, int64_t max_periods, int64_t n, double *state, int32_t *label);

/* Follows n starts (state [n][2], in and out) up to `periods` periods: label [n] = attractor, 0 where the start has not
 * settled. In kept stages. Collective. */
kz_status kz_settle(const kz_run *run, kz_dynamics *dynamics, int64_t periods, int64_t n, double *state, int32_t *label);

/* The same with KZ_SEARCH_FEW starts at most, by this process alone: *n of them, state and label [KZ_SEARCH_FEW] as above. What all would take
 * is added to *seconds, processor time; a map table of few nodes is made. Not collective. */
enum { KZ_SEARCH_FEW = 256, KZ_SEARCH_MOST_SOUGHT = 1024 /* starts that a round looks for cycles from */ };
kz_status kz_search_measure(kz_dynamics *dynamics, const kz_search *search, double *state, int32_t *label, int64_t *n,
                            double *seconds);

/* The search for the attractors of a basin, of a window, and of the scene's study basin or attractors, the last without a map table. The largest
 * speed is left to the caller, who has the dynamics. */
kz_search kz_search_of_basin(const kz_basin_plan *plan);
kz_search kz_search_of_attractors(const kz_attractors_plan *plan, int64_t max_periods);
kz_search kz_search_of(const kz_scene *scene);

#endif
