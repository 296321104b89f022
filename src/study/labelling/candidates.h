/* Labels by states alone, and what starts get that no level decides. */
#pragma once

#include "kapitza/dynamics_labels.h"

/* Labels of items that no level decides: KZ_DOUBTFUL; the label of the state without its error, in doubles or in quad
 * precision; in doubles and, as second candidate, the attractor of the nearest start that ends elsewhere. */
typedef enum { KZ_OPEN_DOUBTFUL, KZ_OPEN_BY_STATES, KZ_OPEN_IN_QUADS, KZ_OPEN_CANDIDATES } kz_open;

/* The states of n starts: state [n][2], half-turns and velocity. */
void kz_states_of(int64_t n, const kz_start *start, double *state);

/* Labels n released starts by state alone; state [n][2] becomes the last one; start NULL: they are states at 0. */
void kz_decide_by_states(kz_dynamics *dynamics, kz_stepper stepper, int64_t max_periods, int64_t n,
                         const kz_start *start, double *state, kz_decision *decision);

/* Decides n released starts in the way `open`. */
void kz_candidates_find(kz_dynamics *dynamics, int64_t max_periods, kz_open open, int64_t n, const kz_start *start,
                        kz_decision *decision);
/* The level for which these starts are made. */
kz_precision kz_candidates_level(kz_open open);
