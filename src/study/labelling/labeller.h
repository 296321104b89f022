/* The labeller turns starts into labels. It tries one precision level after the other until one decides the label. Grids of cells, single
 * starts, pairs at a boundary and windows of any depth are ways to make starts. Nothing here is collective: stages distribute the work. */
#ifndef KAPITZA_STUDY_LABELLER_H
#define KAPITZA_STUDY_LABELLER_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* Makes the start of an item for a level. Finer levels may begin their own arithmetic earlier, after fewer periods. */
typedef kz_status (*kz_start_fn)(void *context, int64_t item, int32_t level, kz_start *start);

/* Follows one item in as many digits as needed (level KZ_LEVEL_ARBITRARY). decision->label stays KZ_DOUBTFUL if this does not decide it. */
typedef kz_status (*kz_decide_fn)(void *context, int64_t item, kz_decision *decision);

typedef struct {
  kz_dynamics *dynamics;
  int64_t max_periods;
  kz_start_fn start;
  kz_decide_fn decide; /* NULL = items that quad precision does not decide stay undecided */
  void *context;       /* of start and decide */
} kz_labeller;

/* The labeller of cells whose centres are doubles; the items are their numbers. */
kz_labeller kz_cell_labeller(const kz_basin_plan *plan, kz_dynamics *dynamics);
/* The exact start (theta in rad, velocity in rad per drive radian). */
static inline kz_start kz_start_at(double theta, double velocity) {
  return (kz_start){.theta = {theta, 0}, .velocity = {velocity, 0}};
}

/* Labels n items at one level; `before` is the level at which they were doubtful. decision [n] as in kz_dynamics_label. */
kz_status kz_label_at(const kz_labeller *labeller, int32_t level, int32_t before, int64_t n, const int64_t *item,
                      kz_decision *decision);
/* Labels n items by their states alone, without errors, as kz_dynamics_follow follows them: label [n], periods [n]. */
kz_status kz_label_states(const kz_labeller *labeller, int32_t stepping, int64_t n, const int64_t *item, int32_t *label,
                          int64_t *periods);

/* The level that follows `level` if `pending` items are left; KZ_LEVELS = none. A few items go to quad precision at once, because they take
 * less time there than the tables of the pairs of doubles. */
int32_t kz_level_after(const kz_labeller *labeller, int32_t level, int64_t pending);

/* Sets the candidates of n undecided items: label and periods by the scene's numerics without errors, and `other`, the attractor of the
 * nearest start that ends elsewhere. */
kz_status kz_label_candidates(const kz_labeller *labeller, int64_t n, const int64_t *item, kz_decision *decision);

/* Labels n items by one level after the other until each is decided. An item that no level decides has KZ_DOUBTFUL and level KZ_LEVELS. */
kz_status kz_label(const kz_labeller *labeller, int64_t n, const int64_t *item, kz_decision *decision);

/* Follows n starts, start [n][2] (rad, rad per drive radian), by direct integration. end [n] = number of the attractor in kz_dynamics, 0 = not
 * settled; periods [n] = drive periods until then. */
void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);
/* The same by the precision levels. A start that no level decides gets the end by direct integration. */
void kz_decide_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods);

/* Moves n starts from their release to the strobe at which labelling begins. state [n][2] = half-turns and velocity there. */
void kz_released_states(kz_dynamics *dynamics, int64_t n, kz_start *start, double *state);

#endif
