/* What starts get that no level decides. */
#pragma once

#include <stdint.h>

#include "kapitza/dynamics_labels.h"

/* What items get that no level decides: KZ_DOUBTFUL; the label of the state without its error, in doubles or in quad precision; in doubles
 * and, as second candidate, the attractor of the nearest start that ends elsewhere. */
enum { KZ_OPEN_DOUBTFUL, KZ_OPEN_BY_STATES, KZ_OPEN_IN_QUADS, KZ_OPEN_CANDIDATES };

/* A decision by the state alone: the label of a start that was followed for so many periods to a state, with so many turns. */
kz_decision kz_decision_by_state(const kz_start *start, int32_t label, int64_t periods, const double state[2], int64_t turns);

/* The states of n starts: state [n][2], half-turns and velocity. */
void kz_states_of(int64_t n, const kz_start *start, double *state);

/* Decides n released starts in the way `open`. */
void kz_candidates_find(kz_dynamics *dynamics, int64_t max_periods, int32_t open, int64_t n, const kz_start *start,
                        kz_decision *decision);
/* The level for which these starts are made. */
int32_t kz_candidates_level(int32_t open);
