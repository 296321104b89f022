#include "starts.h"

#include <stdlib.h>

#include "labeller.h"
#include "numerics/cells.h"

enum { BATCH = 4096 };

void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods) {
  double state[2 * BATCH];
  for (int64_t done = 0; done < n; done += BATCH) {
    const int64_t part = n - done < BATCH ? n - done : BATCH;
    for (int64_t i = 0; i < part; i++) kz_start_state(start[2 * (done + i)], start[2 * (done + i) + 1], state + 2 * i);
    kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, part, max_periods, state, end + done, periods + done);
  }
}

void kz_decide_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods) {
  kz_start *exact = kz_malloc((size_t)n * sizeof *exact + 1);
  kz_decision *decision = kz_malloc((size_t)n * sizeof *decision + 1);
  const kz_labeller labeller = {.dynamics = dynamics, .max_periods = max_periods, .start = kz_start_of_array, .context = exact};
  for (int64_t i = 0; i < n; i++) exact[i] = kz_start_at(start[2 * i], start[2 * i + 1]);
  (void)kz_label(&labeller, n, NULL, decision); /* starts of an array cannot fail */
  for (int64_t i = 0; i < n; i++) {
    end[i] = decision[i].label;
    periods[i] = decision[i].periods;
    if (end[i] == KZ_DOUBTFUL) kz_follow_starts(dynamics, max_periods, 1, start + 2 * i, end + i, periods + i);
  }
  free(exact);
  free(decision);
}

void kz_released_states(kz_dynamics *dynamics, int64_t n, kz_start *start, double *state) {
  kz_dynamics_release(dynamics, KZ_LEVEL_DOUBLE, n, start);
  for (int64_t i = 0; i < n; i++) kz_start_state(start[i].theta[0], start[i].velocity[0], state + 2 * i);
}
