/* One value of each of a row of things as a variable of the file. */
#ifndef KAPITZA_STUDY_COLUMN_H
#define KAPITZA_STUDY_COLUMN_H

#include <stdlib.h>

#include "kapitza/store.h"

/* Writes GROUP/NAME of n values of a type; `expression` gives value i. Returns from the function that it stands in where it
 * fails. */
#define KZ_COLUMN(store, group, name, n, type, expression)                         \
  do {                                                                             \
    const int64_t column_n = (n);                                                  \
    type *column = calloc((size_t)column_n + 1, sizeof *column);                   \
    if (!column) return kz_fail(KZ_FAILED, "no memory for /" group "/" name);      \
    for (int64_t i = 0; i < column_n; i++) column[i] = (type)(expression);         \
    const kz_status column_status = kz_store_variable(store, group, name, column); \
    free(column);                                                                  \
    KZ_TRY(column_status);                                                         \
  } while (0)

#endif
