#include "kapitza/kernel.h"

int32_t kz_scheme_find(const char *name) {
  for (int32_t row = 0; row < kz_scheme_count(); row++)
    if (strcmp(kz_scheme_at(row).name, name) == 0) return row;
  return -1;
}
