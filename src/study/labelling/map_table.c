#include "map_table.h"

#include <stdlib.h>

enum { ROWS = 4 }; /* per tile */

typedef struct {
  kz_dynamics *dynamics;
  int64_t n_velocity;
} table;

static kz_status table_tile(void *context, int64_t tile, void *record) {
  const table *t = context;
  int64_t size = kz_dynamics_table_row_size(t->dynamics);
  for (int64_t row = tile * ROWS; row < (tile + 1) * ROWS && row < t->n_velocity; row++)
    kz_dynamics_table_row(t->dynamics, row, (double *)record + (row - tile * ROWS) * size);
  return KZ_OK;
}

kz_status kz_map_table_make(const kz_run *run, kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity,
                            double max_velocity) {
  table t = {dynamics, n_velocity};
  kz_dynamics_table_create(dynamics, n_theta, n_velocity, max_velocity);
  const kz_stage stage = kz_stage_for_all("map table", (n_velocity + ROWS - 1) / ROWS,
                                          ROWS * (size_t)kz_dynamics_table_row_size(dynamics) * sizeof(double), table_tile, &t);
  double *rows = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_status status = kz_stage_run(run, &stage, rows);
  if (status == KZ_OK) kz_dynamics_table_set(dynamics, rows);
  free(rows);
  return status;
}
