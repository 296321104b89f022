/* What a search for attractors takes: one from few starts is timed, then what one start more takes, and a node of the map table. */
#include <math.h>

#include "labelling/map_table.h"
#include "search.h"

enum { FEW_NODES = 200 }; /* an axis, of the table that is timed */

static int64_t smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}

/* The starts beyond those of the search, once the regions have grown. */
static kz_status measure_rest(kz_dynamics *dynamics, const kz_search *search, int64_t rest, double *seconds) {
  enum { SAMPLE = 256 };
  double state[2 * SAMPLE];
  int32_t label[SAMPLE];
  if (rest <= 0) return KZ_OK;
  kz_dynamics_starts(&search->window, search->seed + 1, SAMPLE, state);
  const double start = kz_processor_clock();
  KZ_TRY(kz_settle(NULL, dynamics, search->max_periods, SAMPLE, state, label));
  *seconds += (kz_processor_clock() - start) / SAMPLE * (double)rest;
  return KZ_OK;
}

static kz_status measure_table(kz_dynamics *dynamics, const kz_search *search, double *seconds) {
  const int64_t columns = smaller(search->table_theta, FEW_NODES), rows = smaller(search->table_velocity, FEW_NODES);
  if (search->table_theta == 0) return KZ_OK;
  const double start = kz_processor_clock();
  KZ_TRY(kz_map_table_make(NULL, dynamics, columns, rows, search->max_velocity));
  *seconds +=
      (kz_processor_clock() - start) * (double)(search->table_theta * search->table_velocity) / (double)(columns * rows);
  return KZ_OK;
}

kz_status kz_search_measure(kz_dynamics *dynamics, const kz_search *search, double *state, int32_t *label, int64_t *n,
                            double *seconds) {
  kz_search few = *search;
  few.starts = *n = smaller(search->starts, KZ_SEARCH_FEW);
  few.table_theta = 0;
  const double start = kz_processor_clock();
  KZ_TRY(kz_search_window(NULL, dynamics, &few, state, label));
  *seconds += kz_processor_clock() - start;
  KZ_TRY(measure_rest(dynamics, search, search->starts - few.starts, seconds));
  return measure_table(dynamics, search, seconds);
}
