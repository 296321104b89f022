#include "live.h"

int64_t kz_level_pending(int64_t level, int64_t rows, int64_t columns, int64_t own, bool *listed, int64_t *number) {
  int64_t n = 0;
  for (int64_t i = 0; i < kz_level_size(level, rows); i++)
    for (int64_t j = 0; j < kz_level_size(level, columns); j++) {
      const int64_t f = kz_level_place(level, i, rows) * columns + kz_level_place(level, j, columns);
      const int64_t cell = f < own ? f : rows * columns - 1 - f;
      if (listed[cell]) continue;
      listed[cell] = true;
      number[n++] = cell;
    }
  return n;
}
