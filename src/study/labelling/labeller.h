/* The labeller turns starts into labels: it follows them, tries one level of precision after the other until one
 * decides the label, looks for attractors that the starts lead to, and shares its work among ranks in stages that a
 * checkpoint keeps. Grids of cells, single starts, pairs at a boundary, frames and shocks are ways to make starts. */
#pragma once

#include "candidates.h"
#include "levels.h"

/* Makes the start of an item for a level. Finer levels may begin their own arithmetic earlier, after fewer periods. */
typedef kz_status (*kz_start_fn)(void *context, int64_t item, kz_precision level, kz_start *start);

/* Reads a decision beyond its label: the orbit's error, its last state. Called at each level that is tried. */
typedef void (*kz_note_fn)(void *context, int64_t item, const kz_decision *decision);

/* Levels that a power adds, n of them. `label` labels items at a row of theirs, by what carries its orbits; KZ_DOUBTFUL
 * leaves an item to the next level. */
typedef struct {
  const kz_level *rows;
  int32_t n;
  kz_status (*label)(void *context, int32_t row, int64_t n, const int64_t *item, kz_decision *decision);
} kz_added_levels;

/* Ways to label: by the states alone, as kz_dynamics_follow does; by one level, whose doubtful orbits are followed on
 * and marked (method direct); by one level after the other until each item is decided (method exact), those that are
 * added last; by added levels alone. */
typedef enum { KZ_BY_STATES, KZ_BY_MARKS, KZ_BY_LEVELS, KZ_BY_ADDED } kz_way;

typedef struct {
  kz_dynamics *dynamics;
  int64_t max_periods;
  kz_way way;
  kz_open open;
  bool at_strobe; /* the starts lie at a strobe of the final drive; else kz_dynamics_begin moves them there */
  kz_start_fn start;
  const double *state; /* replaces `start` for KZ_BY_STATES: states [n][2], half-turns and velocity; NULL = none */
  const kz_added_levels *added; /* NULL = none: items that quad precision does not decide stay undecided */
  kz_note_fn note;              /* NULL = none */
  void *context;                /* context of the functions */
  const kz_run *run;            /* its ranks share the items, in kept stages; NULL = this process does all */
  const char *stage;            /* name of the first stage; NULL = that of the level */
  int64_t tile;                 /* most items that are followed together; 0 = as many as the level takes */
  bool turns;                   /* count the net turns of each item too */
  kz_stepper stepper;           /* stepper of KZ_BY_STATES */
} kz_labeller;

/* Makes a labeller of starts at a strobe, start [n][2] (rad, rad per drive radian); items are their indices. */
kz_labeller kz_pair_labeller(const double *start, int64_t max_periods, kz_way way, kz_dynamics *dynamics);
/* The exact start (theta in rad, velocity in rad per drive radian). */
static inline kz_start kz_start_at(double theta, double velocity) {
  return (kz_start){.theta = {theta, 0}, .velocity = {velocity, 0}};
}

/* Labels n items, item [n] (NULL: 0, 1, ...): label [n]. `round` numbers stages. Collective if there is a run. */
kz_status kz_label_items(const kz_labeller *labeller, int round, int64_t n, const int64_t *item, kz_label *label_deep);
/* The first level of it, by this process alone; KZ_STOPPED if the run is to stop. And the further levels, for items
 * that it left doubtful: in, label [n] is what it has found. */
kz_status kz_label_first(const kz_labeller *labeller, int64_t n, const int64_t *item, kz_label *label);
kz_status kz_label_doubtful(const kz_labeller *labeller, int round, int64_t n, const int64_t *item, kz_label *label);

/* Labels with their unsettled items, from which a search can go on. Collective if the labeller has a run. */
typedef struct {
  kz_status (*count)(void *labels, int64_t *n);                           /* how many there are */
  kz_status (*pick)(void *labels, int64_t all, int64_t n, int64_t *item); /* n of them all, evenly chosen */
  kz_status (*again)(void *labels, int round);                            /* labels them again */
  void *labels;
} kz_unsettled;
/* Place i of n evenly chosen ones of `all`. */
static inline int64_t kz_even_place(int64_t i, int64_t n, int64_t all) {
  return i * all / n;
}

/* A search that goes on from items: at most `rounds` times, from at most `starts` items. */
typedef struct {
  int rounds;
  int64_t starts;
  int64_t *reached; /* [INT16_MAX + 1] the starts that end on each attractor are added; NULL = not needed */
} kz_search_on;
/* Looks for the attractors that unsettled items lead to, and labels those items again, until all have settled, a search
 * finds nothing or the rounds are over. */
kz_status kz_search_rounds(const kz_labeller *labeller, const kz_search_on *catalogue_search,
                           const kz_unsettled *unsettled);
/* Labels n items in an array and searches on from those that do not settle. */
kz_status kz_label_and_search(const kz_labeller *labeller, const kz_search_on *prepared_search, int64_t n,
                              const int64_t *item, kz_label *label);

/* The states of n items where labels begin to follow them, after their release: state [n][2], half-turns and velocity;
 * periods [n]: drive periods before; NULL = not needed. */
kz_status kz_item_states(const kz_labeller *labeller, int64_t n, const int64_t *item, double *state, int64_t *periods);
