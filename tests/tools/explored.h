/* Pendulums, most of quality factor 5 and drive frequency 11, whose attractors in a window are known. */
#pragma once

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "find.h"
#include "kapitza/kernel.h"
#include "kapitza/dynamics_labels.h"
#include "part.h"

static inline const kz_numerics *fine_numerics(void) {
  static kz_numerics numerics = {.steps_per_period = 16};
  numerics.scheme = kz_scheme_find("split6");
  return &numerics;
}
static const kz_window WINDOW = {-M_PI, M_PI, -2, 2};

enum { STARTS = 1024 };

/* Follows starts and looks for cycles until every start is trapped; cells: 0 = coarse regions, else fine ones that grow
 * with every attractor. */
static inline kz_dynamics *explored_pendulum(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t seed,
                                             int64_t cells, double max_velocity) {
  kz_dynamics *d = kz_dynamics_create(pendulum, numerics, 12);
  double *state = malloc(2 * STARTS * sizeof *state);
  int32_t *label = malloc(STARTS * sizeof *label);
  int64_t *periods = malloc(STARTS * sizeof *periods), n = STARTS;
  assert_non_null(d);
  kz_dynamics_starts(&WINDOW, seed, n, state);
  if (cells > 0)
    kz_dynamics_regions(d, cells, max_velocity);
  else
    kz_dynamics_regions(d, 0, max_velocity);
  for (int round = 0; n > 0 && round < 12; round++) {
    kz_dynamics_update(d);
    kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, n, 128, state, label, periods, NULL);
    int64_t open = 0;
    for (int64_t i = 0; i < n; i++)
      if (label[i] == 0) {
        memmove(state + 2 * open, state + 2 * i, 2 * sizeof *state);
        open++;
      }
    n = open;
    const int64_t some = cells > 0 ? 1 : 64;
    for (int64_t first = 0; first < n; first += some) {
      find_cycles(d, n - first < some ? n - first : some, state + 2 * first, 0.02);
      if (cells > 0 && first < 64) kz_dynamics_update(d);
    }
  }
  assert_int_equal(n, 0);
  free(state);
  free(label);
  free(periods);
  return d;
}

static inline kz_dynamics *explored_with(const kz_numerics *numerics, double m, int64_t seed, int64_t cells,
                                         double max_velocity) {
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, m};
  return explored_pendulum(&pendulum, numerics, seed, cells, max_velocity);
}

static inline kz_dynamics *explored_dynamics(double m, int64_t seed, double max_velocity) {
  return explored_with(fine_numerics(), m, seed, 0, max_velocity);
}

/* Regions of a fine grid, and a map table. */
static inline void with_table(kz_dynamics *d, int64_t nodes, double max_velocity) {
  if (PART > 1) nodes /= 2;
  kz_dynamics_table_create(d, nodes, nodes, max_velocity);
  int64_t size = kz_dynamics_table_row_size(d);
  double *rows = malloc((size_t)(nodes * size) * sizeof *rows);
  for (int64_t row = 0; row < nodes; row++) kz_dynamics_table_row(d, row, rows + row * size);
  kz_dynamics_table_set(d, rows);
  kz_dynamics_regions(d, nodes, max_velocity);
  free(rows);
}

/* A level for orbits that are doubtful at the one before it. */
static inline kz_label_precision next_cheaper(kz_precision level) {
  return (kz_label_precision){.level = level, .before = level > 0 ? level - 1 : 0};
}

/* Labels of n <= 4096 starts (rad). */
static inline void label_starts(kz_dynamics *d, kz_label_precision precision, int64_t n, const double *start,
                                int32_t *label) {
  static kz_start starts[4096];
  static kz_decision decision[4096];
  for (int64_t i = 0; i < n; i++) starts[i] = (kz_start){.theta = {start[2 * i]}, .velocity = {start[2 * i + 1]}};
  kz_dynamics_label(d, &precision, n, starts, 2000, decision);
  for (int64_t i = 0; i < n; i++) label[i] = decision[i].end.label;
}

/* The attractor one of whose strobe points is within 1e-3 rad of the state; 0 = none. */
static inline int32_t circle_at(const kz_dynamics *d, double theta, double velocity) {
  double points[2][64];
  kz_attractor row;
  for (int32_t a = 1; a <= kz_dynamics_count(d); a++) {
    kz_dynamics_attractor(d, a, &row);
    kz_dynamics_strobe(d, a, points[0], points[1]);
    for (int i = 0; i < row.period; i++)
      if (hypot(remainder(theta - points[0][i], 2 * M_PI), velocity - points[1][i]) < 1e-3) return a;
  }
  return 0;
}
