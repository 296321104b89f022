#include <string.h>

#include "kapitza/kernel.h"

int32_t kz_scheme_find(const char *name) {
  kz_scheme scheme;
  for (int32_t row = 0; row < kz_scheme_count(); row++) {
    kz_scheme_row(row, &scheme);
    if (strcmp(scheme.name, name) == 0) return row;
  }
  return -1;
}
