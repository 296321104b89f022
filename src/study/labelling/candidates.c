#include "candidates.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "numerics/cells.h"

enum { BATCH = 64 };

/* The starts beside n <= BATCH states: `places` last places farther out or in, in angle or velocity. */
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

/* Looks ever farther beside the states until each has another end. */
static void find_others(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *state, const int32_t *label,
                        kz_decision *decision) {
  double from[2 * BATCH], end[8 * BATCH];
  int32_t found[4 * BATCH];
  int64_t late[4 * BATCH], open[BATCH], left = n;
  for (int64_t i = 0; i < n; i++) open[i] = i;
  for (double places = 1; left > 0 && places * DBL_EPSILON < 1; places *= 2) {
    const int64_t n_open = left;
    for (int64_t i = 0; i < n_open; i++) memcpy(from + 2 * i, state + 2 * open[i], 2 * sizeof *from);
    step_aside(n_open, from, places, end);
    kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, 4 * n_open, max_periods, end, found, late, NULL);
    left = 0;
    for (int64_t i = 0; i < n_open; i++) {
      const int64_t own = open[i];
      for (int side = 0; side < 4 && decision[own].end.other == 0; side++)
        if (found[4 * i + side] != label[own]) decision[own].end.other = (int16_t)found[4 * i + side];
      if (decision[own].end.other == 0) open[left++] = own;
    }
  }
}

void kz_states_of(int64_t n, const kz_start *start, double *state) {
  for (int64_t i = 0; i < n; i++) kz_start_state(start[i].theta[0], start[i].velocity[0], state + 2 * i);
}

kz_decision kz_decision_by_state(const kz_start *start, int32_t label, int64_t periods, const double state[2], int64_t turns) {
  return (kz_decision){.end = {.periods = start->periods + periods, .label = (int16_t)label},
                       .level = KZ_LEVELS,
                       .error = NAN,
                       .state = {state[0], state[1]},
                       .turns = start->turns + llrint(start->theta[0] / (2 * M_PI)) + turns,
                       .from = start->periods > 0 ? start->from : start->theta[0]};
}

static void find_some(kz_dynamics *dynamics, int64_t max_periods, bool others, int64_t n, const kz_start *start,
                      kz_decision *decision) {
  double state[2 * BATCH] = {0}, end[2 * BATCH];
  int32_t label[BATCH];
  int64_t periods[BATCH], turns[BATCH];
  kz_states_of(n, start, state);
  memcpy(end, state, sizeof state);
  kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, n, max_periods, end, label, periods, turns);
  for (int64_t i = 0; i < n; i++) decision[i] = kz_decision_by_state(start + i, label[i], periods[i], end + 2 * i, turns[i]);
  if (others) find_others(dynamics, max_periods, n, state, label, decision);
}

/* In quad precision, whose error is ignored: it acts like a change of the start by so much. */
static void follow_in_quads(kz_dynamics *dynamics, int64_t max_periods, const kz_start *s, kz_decision *decision) {
  int32_t label;
  *decision = (kz_decision){.level = KZ_LEVELS, .error = NAN};
  kz_dynamics_follow_reference(dynamics, KZ_REFERENCE_STEPS, 1, max_periods - s->periods,
                               (double[]){s->theta[0], s->velocity[0]}, (double[]){s->theta[1], s->velocity[1]}, &label,
                               &decision->end.periods);
  decision->end.label = (int16_t)label;
}

int32_t kz_candidates_level(int32_t open) {
  return open == KZ_OPEN_IN_QUADS ? KZ_LEVEL_QUAD : KZ_LEVEL_DOUBLE;
}

void kz_candidates_find(kz_dynamics *dynamics, int64_t max_periods, int32_t open, int64_t n, const kz_start *start,
                        kz_decision *decision) {
  for (int64_t i = 0; open == KZ_OPEN_IN_QUADS && i < n; i++) follow_in_quads(dynamics, max_periods, start + i, decision + i);
  for (int64_t done = 0; open != KZ_OPEN_IN_QUADS && done < n; done += BATCH)
    find_some(dynamics, max_periods, open == KZ_OPEN_CANDIDATES, n - done < BATCH ? n - done : BATCH, start + done,
              decision + done);
}
