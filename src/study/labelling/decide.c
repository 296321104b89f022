#include "decide.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"

/* The starts that are open. */
typedef struct {
  int64_t n;
  int64_t *place, *periods;
  double *start, *low, *reach;
  int32_t *label;
} room;

static bool open_room(int64_t n, room *r) {
  const size_t count = (size_t)n + 1;
  *r = (room){.n = n,
              .place = malloc(count * sizeof(int64_t)),
              .periods = malloc(count * sizeof(int64_t)),
              .start = malloc(2 * count * sizeof(double)),
              .low = malloc(2 * count * sizeof(double)),
              .reach = malloc(count * sizeof(double)),
              .label = malloc(count * sizeof(int32_t))};
  return r->place && r->periods && r->start && r->low && r->reach && r->label;
}

static void close_room(room *r) {
  free(r->place);
  free(r->periods);
  free(r->start);
  free(r->low);
  free(r->reach);
  free(r->label);
}

/* Those that stay open move to the front. */
static void take(room *r, int32_t rung, kz_decision *decision) {
  int64_t open = 0;
  for (int64_t i = 0; i < r->n; i++) {
    const bool is_open = r->label[i] == KZ_DOUBTFUL;
    decision[r->place[i]] = (kz_decision){r->label[i], is_open ? KZ_RUNGS : rung, r->periods[i], r->reach[i]};
    if (!is_open) continue;
    r->place[open] = r->place[i];
    memmove(r->start + 2 * open, r->start + 2 * i, 2 * sizeof(double));
    memmove(r->low + 2 * open++, r->low + 2 * i, 2 * sizeof(double));
  }
  r->n = open;
}

kz_status kz_decide(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, const double *low,
                    kz_decision *decision) {
  room r;
  const bool has_room = open_room(n, &r);
  for (int64_t i = 0; has_room && i < n; i++) {
    r.place[i] = i;
    memcpy(r.start + 2 * i, start + 2 * i, 2 * sizeof *start);
    for (int axis = 0; axis < 2; axis++) r.low[2 * i + axis] = low ? low[2 * i + axis] : 0;
  }
  for (int32_t rung = 0; has_room && rung < KZ_RUNGS && r.n > 0; rung++) {
    kz_dynamics_follow_errors(dynamics, rung, r.n, max_periods, r.start, r.low, r.label, r.periods, r.reach);
    take(&r, rung, decision);
  }
  close_room(&r);
  return has_room ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)n);
}

void kz_decide_prepare(kz_dynamics *dynamics) {
  const double start[2] = {0, 0};
  int32_t label;
  int64_t periods;
  for (int32_t rung = 0; rung < KZ_RUNGS; rung++)
    kz_dynamics_follow_errors(dynamics, rung, 0, 0, start, NULL, &label, &periods, NULL);
}

/* The starts beside n <= KZ_FEW states: `places` last places farther out or in, in angle or velocity. */
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

void kz_find_candidates(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *label,
                        int64_t *periods, int32_t *other) {
  double state[2 * KZ_FEW] = {0}, end[8 * KZ_FEW];
  int32_t found[4 * KZ_FEW];
  int64_t late[4 * KZ_FEW];
  bool is_open = n > 0;
  for (int64_t i = 0; i < n; i++) kz_start_state(start[2 * i], start[2 * i + 1], state + 2 * i);
  memcpy(end, state, sizeof state);
  kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, n, max_periods, end, label, periods);
  memset(other, 0, (size_t)n * sizeof *other);
  for (double places = 1; is_open && places * DBL_EPSILON < 1; places *= 2) {
    step_aside(n, state, places, end);
    kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, 4 * n, max_periods, end, found, late);
    for (int64_t i = 0; i < 4 * n; i++)
      if (other[i / 4] == 0 && found[i] != label[i / 4]) other[i / 4] = found[i];
    is_open = false;
    for (int64_t i = 0; i < n; i++) is_open = is_open || other[i] == 0;
  }
}
