/* The candidates of starts that no level decides. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "labeller.h"

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
static void find_others(const kz_labeller *l, int64_t n, const double *state, const int32_t *label, kz_decision *decision) {
  double from[2 * BATCH], end[8 * BATCH];
  int32_t found[4 * BATCH];
  int64_t late[4 * BATCH], open[BATCH], left = n;
  for (int64_t i = 0; i < n; i++) open[i] = i;
  for (double places = 1; left > 0 && places * DBL_EPSILON < 1; places *= 2) {
    const int64_t asked = left;
    for (int64_t i = 0; i < asked; i++) memcpy(from + 2 * i, state + 2 * open[i], 2 * sizeof *from);
    step_aside(asked, from, places, end);
    kz_dynamics_follow(l->dynamics, KZ_FOLLOW_DIRECT, 4 * asked, l->max_periods, end, found, late);
    left = 0;
    for (int64_t i = 0; i < asked; i++) {
      const int64_t own = open[i];
      for (int side = 0; side < 4 && decision[own].other == 0; side++)
        if (found[4 * i + side] != label[own]) decision[own].other = found[4 * i + side];
      if (decision[own].other == 0) open[left++] = own;
    }
  }
}

static kz_status find_some(const kz_labeller *l, int64_t n, const int64_t *item, kz_decision *decision) {
  double state[2 * BATCH] = {0}, end[2 * BATCH];
  int32_t label[BATCH];
  int64_t periods[BATCH];
  kz_start start[BATCH];
  for (int64_t i = 0; i < n; i++) KZ_TRY(l->start(l->context, item[i], KZ_LEVEL_DOUBLE, start + i));
  kz_released_states(l->dynamics, n, start, state);
  for (int64_t i = 0; i < n; i++) decision[i] = (kz_decision){.level = KZ_LEVELS, .error = NAN, .periods = start[i].periods};
  memcpy(end, state, sizeof state);
  kz_dynamics_follow(l->dynamics, KZ_FOLLOW_DIRECT, n, l->max_periods, end, label, periods);
  for (int64_t i = 0; i < n; i++) {
    decision[i].label = label[i];
    decision[i].periods += periods[i];
  }
  find_others(l, n, state, label, decision);
  return KZ_OK;
}

kz_status kz_label_candidates(const kz_labeller *l, int64_t n, const int64_t *item, kz_decision *decision) {
  for (int64_t done = 0; done < n; done += BATCH)
    KZ_TRY(find_some(l, n - done < BATCH ? n - done : BATCH, item + done, decision + done));
  return KZ_OK;
}
