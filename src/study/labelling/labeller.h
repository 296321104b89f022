/* The labeller: starts in, labels out. It owns the dynamics with their attractors and trapping regions, and the precision levels that a
 * start is asked at until one decides its label. Grids of cells, single starts, pairs at a boundary, windows of any depth are ways to
 * make starts. Nothing here is collective: stages distribute it. */
#ifndef KAPITZA_STUDY_LABELLER_H
#define KAPITZA_STUDY_LABELLER_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/dynamics.h"

/* Makes the start of an item as a level needs it: finer levels may begin their own arithmetic earlier, with fewer periods spent. */
typedef kz_status (*kz_start_fn)(void *context, int64_t item, int32_t level, kz_start *start);

/* Follows one item in as many digits as it takes (level KZ_LEVEL_ARBITRARY): decision->label stays KZ_DOUBTFUL where even they do not decide. */
typedef kz_status (*kz_decide_fn)(void *context, int64_t item, kz_decision *decision);

typedef struct {
  kz_dynamics *dynamics;
  int64_t max_periods;
  kz_start_fn start;
  kz_decide_fn decide; /* NULL: what quad precision leaves open stays undecided */
  void *context;       /* of both */
} kz_labeller;

/* A kz_start_fn: the items are places in an array of starts, which is the context. */
kz_status kz_start_of_array(void *context, int64_t item, int32_t level, kz_start *start);
/* A start at rad and rad per drive radian, exact. */
kz_start kz_start_at(double theta, double velocity);

/* Labels n items at one level, which takes what `before` left; decision [n] as of kz_dynamics_label. */
kz_status kz_label_at(const kz_labeller *labeller, int32_t level, int32_t before, int64_t n, const int64_t *item,
                      kz_decision *decision);

/* The level that takes the `pending` items that `level` leaves; KZ_LEVELS: none. Few of them go to quad precision at once: they take less time
 * there than the tables of the pairs of doubles. */
int32_t kz_level_after(const kz_labeller *labeller, int32_t level, int64_t pending);

/* What no level decides: label and periods become those of the scene's numerics without regard to errors, other the attractor of the
 * nearest start that ends elsewhere. */
kz_status kz_label_candidates(const kz_labeller *labeller, int64_t n, const int64_t *item, kz_decision *decision);

/* Labels n items: the levels one after the other until each is decided. KZ_DOUBTFUL, with level KZ_LEVELS, where none decides. */
kz_status kz_label(const kz_labeller *labeller, int64_t n, const int64_t *item, kz_decision *decision);

#endif
