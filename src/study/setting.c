/* One setting measured: its own dynamics with the judge's attractors, its labels of the judge's cells, its time. */
#include "setting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "basin.h"
#include "map_table.h"

enum { CHUNK = 4096 }; /* cells labelled at a time */

typedef struct {
  const kz_setting *setting;
  const kz_judge *judge;
  kz_dynamics *dynamics;
  double horizon;
  double spare; /* seconds for labels of neighbours, which a whole grid has anyway */
} gauge;

/* Processor time of this thread: what others do on the machine does not count. */
static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Half-turns and velocity of cell f, `right` and `up` cells aside. */
static void state_at(const kz_basin_plan *plan, int64_t f, int64_t right, int64_t up, double *state) {
  const double half_turns = kz_axis_centre(&plan->theta, f % plan->theta.count + right) / M_PI;
  state[0] = half_turns - 2 * rint(half_turns / 2);
  state[1] = kz_axis_centre(&plan->velocity, f / plan->theta.count + up);
}

/* Hybrid on cells by themselves: the table's labels of each cell and its four neighbours tell which to integrate. */
static void label_hybrid(gauge *g, int64_t n, const int64_t *cell, int32_t *owner) {
  static const int64_t aside[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const kz_basin_plan *plan = g->judge->plan;
  double state[5 * 2 * CHUNK / 4];
  int32_t five[5 * CHUNK / 4], again_owner[CHUNK / 4];
  int64_t periods[5 * CHUNK / 4], again[CHUNK / 4], n_again = 0;
  for (int64_t i = 0; i < 5 * n; i++) state_at(plan, cell[i / 5], aside[i % 5][0], aside[i % 5][1], state + 2 * i);
  const double start = seconds();
  kz_dynamics_follow_table(g->dynamics, kz_stencil[g->setting->interpolation], 5 * n, plan->max_periods, state, five, periods);
  g->spare += 4.0 / 5 * (seconds() - start);
  for (int64_t i = 0; i < n; i++) {
    bool differs = false;
    for (int j = 1; j < 5; j++) differs = differs || five[5 * i + j] != five[5 * i];
    owner[i] = five[5 * i];
    if (kz_distrusted(owner[i], periods[5 * i], g->horizon, differs)) again[n_again++] = i;
  }
  for (int64_t i = 0; i < n_again; i++) state_at(plan, cell[again[i]], 0, 0, state + 2 * i);
  kz_dynamics_follow(g->dynamics, n_again, plan->max_periods, state, again_owner, periods);
  for (int64_t i = 0; i < n_again; i++) owner[again[i]] = again_owner[i];
}

static void label_chunk(gauge *g, int64_t n, const int64_t *cell, int32_t *owner) {
  const kz_basin_plan *plan = g->judge->plan;
  double state[2 * CHUNK];
  int64_t periods[CHUNK];
  for (int64_t i = 0; i < n; i++) state_at(plan, cell[i], 0, 0, state + 2 * i);
  if (g->setting->method == KZ_METHOD_DIRECT)
    kz_dynamics_follow(g->dynamics, n, plan->max_periods, state, owner, periods);
  else
    kz_dynamics_follow_table(g->dynamics, kz_stencil[g->setting->interpolation], n, plan->max_periods, state, owner, periods);
}

/* Labels [n] of the first n cells of the judge's order. */
static void label(gauge *g, int64_t n, int32_t *owner) {
  const bool hybrid = g->setting->method == KZ_METHOD_HYBRID;
  const int64_t most = hybrid ? CHUNK / 4 : CHUNK;
  int64_t cell[CHUNK];
  for (int64_t first = 0; first < n; first += most) {
    const int64_t some = n - first < most ? n - first : most;
    for (int64_t i = 0; i < some; i++) cell[i] = kz_judge_cell(g->judge, first + i);
    (hybrid ? label_hybrid : label_chunk)(g, some, cell, owner + first);
  }
}

/* The largest difference between the counts of one attractor among labels and among true ones. */
static int64_t astray(const kz_judge *judge, const int32_t *owner, int64_t *surplus, int64_t known) {
  int64_t largest = 0;
  memset(surplus, 0, (size_t)(known + 1) * sizeof *surplus);
  for (int64_t i = 0; i < judge->samples; i++) {
    surplus[owner[i]]++;
    surplus[judge->verdicts[i].label]--;
  }
  for (int64_t a = 1; a <= known; a++)
    if (llabs(surplus[a]) > largest) largest = llabs(surplus[a]);
  return largest;
}

static void compare(const kz_judge *judge, const int32_t *owner, kz_measured *m) {
  int64_t at[KZ_JUDGE_FAR + 1] = {0}, seen = 0;
  for (int64_t i = 0; i < judge->samples; i++)
    if (owner[i] != judge->verdicts[i].label) at[judge->verdicts[i].distance]++;
  for (int distance = 1; distance <= KZ_JUDGE_FAR; distance++) m->wrong += at[distance];
  m->inside = m->wrong - at[1];
  for (int distance = 1; distance <= KZ_JUDGE_FAR && m->wrong > 0 && m->distance == 0; distance++)
    if (2 * (seen += at[distance]) >= m->wrong) m->distance = distance;
}

static kz_status set_up(gauge *g) {
  const kz_setting *s = g->setting;
  kz_dynamics_unpack(g->dynamics, g->judge->packed_size, g->judge->packed);
  KZ_TRY(kz_map_table_make(NULL, g->dynamics, s->nodes, s->nodes, g->judge->reach));
  if (s->method == KZ_METHOD_HYBRID) g->horizon = kz_dynamics_trust_horizon(g->dynamics, kz_stencil[s->interpolation]);
  return KZ_OK;
}

static kz_status measure(gauge *g, int64_t n, int32_t *owner, int64_t *surplus, kz_measured *m) {
  const double start = seconds();
  KZ_TRY(set_up(g));
  const double ready = seconds();
  label(g, n, owner);
  *m = (kz_measured){.set_up = ready - start, .cell = (seconds() - ready - g->spare) / (double)n};
  compare(g->judge, owner, m);
  m->astray = astray(g->judge, owner, surplus, kz_dynamics_count(g->dynamics));
  return KZ_OK;
}

kz_status kz_setting_measure(const kz_setting *setting, const kz_judge *judge, int64_t timed, kz_measured *measured) {
  gauge g = {.setting = setting, .judge = judge};
  const kz_numerics numerics = kz_setting_numerics(setting);
  int64_t n = timed > judge->samples ? timed : judge->samples;
  if (n > judge->total) n = judge->total;
  g.dynamics = kz_dynamics_create(&judge->pendulum, &numerics, judge->plan->max_period);
  int32_t *owner = malloc((size_t)n * sizeof *owner + 1);
  int64_t *surplus = calloc(INT16_MAX + 1, sizeof *surplus);
  kz_status status = g.dynamics && owner && surplus ? measure(&g, n, owner, surplus, measured)
                                                    : kz_fail(KZ_FAILED, "no memory for the setting %s", setting->label);
  if (g.dynamics) kz_dynamics_free(g.dynamics);
  free(owner);
  free(surplus);
  return status;
}
