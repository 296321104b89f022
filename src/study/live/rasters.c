#include "live.h"

int64_t kz_raster_pending(int64_t coarseness, int64_t rows, int64_t columns, int64_t own, bool *listed,
                          int64_t *number) {
  int64_t n = 0;
  for (int64_t i = 0; i < kz_raster_size(coarseness, rows); i++)
    for (int64_t j = 0; j < kz_raster_size(coarseness, columns); j++) {
      const int64_t f = kz_raster_place(coarseness, i, rows) * columns + kz_raster_place(coarseness, j, columns);
      const int64_t cell = f < own ? f : rows * columns - 1 - f;
      if (listed[cell]) continue;
      listed[cell] = true;
      number[n++] = cell;
    }
  return n;
}
