/* Method exact: the rungs of precision, from the scene's numerics up, each for the cells that the one below leaves doubtful; and the
 * candidates of those that none decides. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "label_parts.h"

enum { FEW = 64 }; /* cells of a tile that takes long */

typedef struct {
  const char *name; /* of its stages; the first one's are those of all cells */
  int64_t tile;     /* cells that it takes at a time, where it takes those that another one left */
  uint8_t evidence; /* of what it labels */
} rung;

static const rung rungs[KZ_RUNGS + 1] = {
    [KZ_RUNG_DOUBLE] = {"cells", 4096, KZ_FOLLOWED},
    [KZ_RUNG_PAIRS] = {"pairs", 512, KZ_IN_PAIRS},
    [KZ_RUNG_QUAD] = {"quad", FEW, KZ_IN_QUAD},
    [KZ_RUNGS] = {"candidates", FEW, KZ_UNDECIDED},
};

int64_t kz_rung_tile(int number) {
  return rungs[number].tile;
}

/* The starts beside n <= FEW states: `places` last places farther out or in, in angle or velocity. */
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

/* The attractor of the nearest start that ends elsewhere, for n <= FEW cells; 0 = none seen. */
static void find_others(const kz_labelling *l, int64_t n, const double *state, kz_labelled *out) {
  double beside[8 * FEW];
  int32_t label[4 * FEW];
  int64_t periods[4 * FEW];
  for (double places = 1; places * DBL_EPSILON < 1; places *= 2) {
    bool is_open = false;
    step_aside(n, state, places, beside);
    kz_dynamics_follow(l->dynamics, KZ_FOLLOW_DIRECT, 4 * n, l->plan->max_periods, beside, label, periods);
    for (int64_t i = 0; i < 4 * n; i++)
      if (out[i / 4].other == 0 && label[i] != out[i / 4].label) out[i / 4].other = (int16_t)label[i];
    for (int64_t i = 0; i < n; i++) is_open = is_open || out[i].other == 0;
    if (!is_open) return;
  }
}

/* Where the scene's numerics end without regard to their errors, and where the nearest starts do that end elsewhere. */
static void find_candidates(const kz_labelling *l, int64_t n, const double *start, kz_labelled *out) {
  double state[2 * FEW] = {0}, end[2 * FEW];
  int32_t label[FEW];
  int64_t periods[FEW];
  for (int64_t i = 0; i < n; i++) kz_start_state(start[2 * i], start[2 * i + 1], state + 2 * i);
  memcpy(end, state, sizeof end);
  kz_dynamics_follow(l->dynamics, KZ_FOLLOW_DIRECT, n, l->plan->max_periods, end, label, periods);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_labelled){.periods = (uint32_t)periods[i], .label = (int16_t)label[i], .evidence = KZ_UNDECIDED};
  find_others(l, n, state, out);
}

void kz_rung_label(const kz_labelling *l, int64_t n, const double *start, const double *low, int32_t *label, int64_t *periods,
                   kz_labelled *out) {
  if (l->rung == KZ_RUNGS) {
    find_candidates(l, n, start, out);
    return;
  }
  kz_dynamics_follow_errors(l->dynamics, l->rung, n, l->plan->max_periods, start, low, label, periods, NULL);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_labelled){.periods = (uint32_t)periods[i], .label = (int16_t)label[i], .evidence = rungs[l->rung].evidence};
}

kz_status kz_rungs_climb(kz_labelling *l, int round) {
  char name[32];
  for (l->rung = 1; l->rung <= KZ_RUNGS; l->rung++) {
    KZ_TRY(kz_open_count(l, KZ_DOUBTFUL));
    if (l->before[l->tiles.own] == 0) break;
    snprintf(name, sizeof name, "%s %d", rungs[l->rung].name, round);
    KZ_TRY(kz_open_label(l, name));
  }
  l->rung = 0;
  return KZ_OK;
}
