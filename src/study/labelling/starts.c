#include "starts.h"

#include "numerics/cells.h"

void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods) {
  enum { BATCH = 4096 };
  double state[2 * BATCH];
  for (int64_t done = 0; done < n; done += BATCH) {
    const int64_t part = n - done < BATCH ? n - done : BATCH;
    for (int64_t i = 0; i < part; i++) kz_start_state(start[2 * (done + i)], start[2 * (done + i) + 1], state + 2 * i);
    kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, part, max_periods, state, end + done, periods + done);
  }
}
