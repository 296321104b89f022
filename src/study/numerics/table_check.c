#include "table_check.h"

#include <math.h>
#include <stdio.h>

#include "cells.h"
#include "step_check.h"

enum { MOST_NODES = 10000 }; /* an axis, that are advised: 2.5 GB */

kz_status kz_steps_check_table(const kz_basin_plan *plan, double table_error) {
  const double cell = kz_cell_size(plan);
  if (!(table_error > cell)) return KZ_OK;
  const int64_t most = plan->table_theta > plan->table_velocity ? plan->table_theta : plan->table_velocity;
  const double nodes = (double)most * pow(table_error / cell, 1.0 / kz_stencil(plan->interpolation));
  char more[64] = "";
  if (nodes <= MOST_NODES) snprintf(more, sizeof more, ", or some %.0f nodes an axis", 100 * ceil(nodes / 100));
  return kz_fail(KZ_REFUSED,
                 "basin.icm|basin.method: the map table has an error of %.2g rad a period, but a cell is %.2g wide; use method "
                 "direct%s",
                 table_error, cell, more);
}

void kz_steps_warn_table(const kz_basin_plan *plan, double table_error, FILE *summary) {
  if (table_error <= kz_steps_tolerance(plan)) return;
  fprintf(summary,
          "warning: the map table has an error of %.2g rad a period (%.2g of a cell); use more nodes (basin.icm), a higher "
          "interpolation, or method direct\n",
          table_error, table_error / kz_cell_size(plan));
}
