#include "candidates.h"

#include <float.h>

#include "numerics/cells.h"

/* The starts beside n states: `places` last places farther out or in, in angle or velocity. */
static void step_aside(int64_t n, const double *state, double places, double *beside) {
  for (int64_t i = 0; i < 4 * n; i++) {
    const double *from = state + 2 * (i / 4);
    const int axis = i / 2 % 2;
    const double step = places * DBL_EPSILON * fmax(1, fabs(from[axis]));
    memcpy(beside + 2 * i, from, 2 * sizeof *from);
    beside[2 * i + axis] += copysign(step, i % 2 ? -from[axis] : from[axis]);
    beside[2 * i] -= 2 * rint(beside[2 * i] / 2);
  }
}

/* Looks ever farther beside n starts until each has another end. */
static void find_others(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const kz_start *start,
                        kz_decision *decision) {
  KZ_AUTOFREE double *state = kz_malloc(10 * (size_t)n * sizeof *state);
  double *end = state + 2 * n;
  KZ_AUTOFREE int32_t *found = kz_malloc(4 * (size_t)n * sizeof *found);
  KZ_AUTOFREE int64_t *late = kz_malloc(5 * (size_t)n * sizeof *late);
  int64_t *open = late + 4 * n;
  int64_t left = n;
  kz_states_of(n, start, state);
  for (int64_t i = 0; i < n; i++) open[i] = i;
  for (double places = 1; left > 0 && places * DBL_EPSILON < 1; places *= 2) {
    const int64_t n_open = left;
    step_aside(n_open, state, places, end);
    kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, 4 * n_open, max_periods, end, found, late, NULL);
    left = 0;
    for (int64_t i = 0; i < n_open; i++) {
      kz_label *own = &decision[open[i]].end;
      for (int side = 0; side < 4 && own->other == 0; side++)
        if (found[4 * i + side] != own->label) own->other = (int16_t)found[4 * i + side];
      if (own->other != 0) continue;
      memmove(state + 2 * left, state + 2 * i, 2 * sizeof *state);
      open[left++] = open[i];
    }
  }
}

void kz_states_of(int64_t n, const kz_start *start, double *state) {
  for (int64_t i = 0; i < n; i++) kz_start_state(start[i].theta[0], start[i].velocity[0], state + 2 * i);
}

void kz_decide_by_states(kz_dynamics *dynamics, kz_stepper stepper, int64_t max_periods, int64_t n,
                         const kz_start *start, double *state, kz_decision *decision) {
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)n * sizeof *label);
  KZ_AUTOFREE int64_t *periods = kz_malloc(2 * (size_t)n * sizeof *periods);
  int64_t *turns = periods + n;
  kz_dynamics_follow(dynamics, stepper, n, max_periods, state, label, periods, turns);
  for (int64_t i = 0; i < n; i++) {
    kz_decision *d = decision + i;
    *d = (kz_decision){.end = {.periods = periods[i], .label = (int16_t)label[i]},
                       .error = NAN,
                       .state = {state[2 * i], state[2 * i + 1]},
                       .turns = turns[i]};
    if (!start) continue;
    d->end.periods += start[i].periods;
    d->turns += start[i].turns + llrint(start[i].theta[0] / (2 * M_PI));
    d->from = start[i].periods > 0 ? start[i].from : start[i].theta[0];
  }
}

/* In quad precision, whose error is ignored: it acts like a change of the start by so much. */
static void follow_in_quads(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const kz_start *start,
                            kz_decision *decision) {
  const kz_label_precision quads = {.level = KZ_LEVEL_QUAD, .series_steps = KZ_REFERENCE_STEPS};
  KZ_AUTOFREE kz_start *exact = memcpy(kz_malloc((size_t)n * sizeof *exact), start, (size_t)n * sizeof *exact);
  for (int64_t i = 0; i < n; i++) memset(exact[i].error, 0, sizeof exact[i].error);
  kz_dynamics_label(dynamics, &quads, n, exact, max_periods, decision);
  for (int64_t i = 0; i < n; i++) decision[i].decided = false;
}

kz_precision kz_candidates_level(kz_open open) {
  return open == KZ_OPEN_IN_QUADS ? KZ_LEVEL_QUAD : KZ_LEVEL_DOUBLE;
}

void kz_candidates_find(kz_dynamics *dynamics, int64_t max_periods, kz_open open, int64_t n, const kz_start *start,
                        kz_decision *decision) {
  if (open == KZ_OPEN_IN_QUADS) {
    follow_in_quads(dynamics, max_periods, n, start, decision);
    return;
  }
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)n * sizeof *state);
  kz_states_of(n, start, state);
  kz_decide_by_states(dynamics, KZ_FOLLOW_DIRECT, max_periods, n, start, state, decision);
  if (open == KZ_OPEN_CANDIDATES) find_others(dynamics, max_periods, n, start, decision);
}
