/* The time of a search for attractors: that of a search from a few starts, of each further start, and of each node of the map table. */
#include <math.h>

#include "search.h"

enum { FEW_NODES = 200, /* an axis, of the table that is timed */ MOST_STARTS = 1 << 14 };

static int64_t smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}

/* Seconds that as many further starts take to settle once the attractors are known. */
static kz_status measure_settling(kz_dynamics *dynamics, const kz_search *search, int64_t n, double *seconds) {
  double state[2 * KZ_SEARCH_FEW];
  int32_t label[KZ_SEARCH_FEW];
  kz_dynamics_starts(&search->window, search->seed + 1, n, state);
  const double start = kz_processor_clock();
  KZ_TRY(kz_settle(NULL, dynamics, search->max_periods, n, state, label));
  *seconds = kz_processor_clock() - start;
  return KZ_OK;
}

/* Attractors that other starts end on, as long as it takes no more than a moment: the whole search knows them, and a start or cell that no
 * region traps would be followed for max_periods. */
static kz_status discover_further(kz_dynamics *dynamics, const kz_search *search) {
  static const double enough = 0.3; /* s */
  const int64_t most = smaller(search->starts, MOST_STARTS);
  KZ_FREED double *state = kz_malloc((size_t)most * 2 * sizeof *state + 1);
  KZ_FREED int32_t *label = kz_malloc((size_t)most * sizeof *label + 1);
  kz_dynamics_starts(&search->window, search->seed, most, state);
  kz_status status = KZ_OK;
  const double start = kz_processor_clock();
  for (int64_t i = 0; i < most && status == KZ_OK && kz_processor_clock() - start < enough; i += KZ_SEARCH_FEW)
    status = kz_discover(NULL, dynamics, search->max_periods, smaller(most - i, KZ_SEARCH_FEW), state + 2 * i, label + i);
  return status;
}

static kz_status measure_table(kz_dynamics *dynamics, const kz_search *search, double *seconds) {
  const int64_t columns = smaller(search->table_theta, FEW_NODES), rows = smaller(search->table_velocity, FEW_NODES);
  if (search->table_theta == 0) return KZ_OK;
  const double start = kz_processor_clock();
  KZ_TRY(kz_map_table_make(NULL, dynamics, columns, rows, kz_search_speed(dynamics, search)));
  *seconds +=
      (kz_processor_clock() - start) * (double)(search->table_theta * search->table_velocity) / (double)(columns * rows);
  return KZ_OK;
}

/* All starts settle; cycles are looked for from few of them at a time, where they settle slowly from many. */
kz_status kz_search_measure(kz_dynamics *dynamics, const kz_search *search, int32_t *label, double *seconds) {
  const int64_t n = smaller(search->starts, KZ_SEARCH_FEW);
  const double speed = kz_search_speed(dynamics, search), start = kz_processor_clock();
  double state[2 * KZ_SEARCH_FEW], settling;
  kz_dynamics_starts(&search->window, search->seed, n, state);
  kz_dynamics_coarse_regions(dynamics, speed);
  KZ_TRY(kz_discover(NULL, dynamics, search->max_periods, n, state, label));
  const double found = kz_processor_clock();
  KZ_TRY(discover_further(dynamics, search));
  const double known = kz_processor_clock();
  kz_regions_grow(dynamics, search->cells, speed);
  *seconds += kz_processor_clock() - known;
  KZ_TRY(measure_settling(dynamics, search, n, &settling));
  *seconds += settling / (double)n * (double)search->starts +
              fmax(0, found - start - settling) / (double)n * (double)smaller(search->starts, KZ_SEARCH_MOST_SOUGHT);
  return measure_table(dynamics, search, seconds);
}
