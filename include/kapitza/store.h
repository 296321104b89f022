/* store: the result file (HDF5, netCDF-4 readable; layer 2). Names, types, units and long names of every dataset of the
 * file's contract are stated once, in a table of this layer. Written by one rank with the serial library.
 *
 * The file grows on disk as PATH.part, and is renamed to PATH when complete. */
#ifndef KAPITZA_STORE_H
#define KAPITZA_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "kapitza/common.h"

typedef struct kz_store kz_store;

/* Name and version of the library. */
const char *kz_store_library(void);

/* Creates PATH.part. KZ_REFUSED where the path cannot be written. */
kz_status kz_store_create(const char *path, kz_store **store);
/* PATH. */
const char *kz_store_path(const kz_store *store);
/* Flushes, closes and renames to PATH (fsync before the rename). Frees the store in every case; where it fails
 * (KZ_FAILED, as on a full disk) no PATH and no PATH.part is left. */
kz_status kz_store_complete(kz_store *store);
/* Closes and removes PATH.part. NULL: nothing. */
void kz_store_discard(kz_store *store);

/* Attributes of a group ("/" = root, "basin" or "/basin"). Text of any length (over 64 KiB too). */
kz_status kz_store_text(kz_store *store, const char *group, const char *name, const char *value);
kz_status kz_store_real(kz_store *store, const char *group, const char *name, double value);
kz_status kz_store_integer(kz_store *store, const char *group, const char *name, int64_t value);

/* A dimension of a group: its scale variable. `values` of the type that the table gives to a variable of that name; NULL
 * for a dimension without coordinates (0, 1, 2, ... is written). */
kz_status kz_store_dimension(kz_store *store, const char *group, const char *name, int64_t length, const void *values);

/* A variable of the table, whole; its dimensions (declared before) are those of the table, its type is the table's:
 * data is an array of double, int8_t, uint8_t, int16_t, int32_t, uint32_t or const char * accordingly. */
kz_status kz_store_variable(kz_store *store, const char *group, const char *name, const void *data);

/* The same, of two dimensions, whose chunks come one by one: `chunk` [2], the cells of one along each. */
kz_status kz_store_chunked(kz_store *store, const char *group, const char *name, const int64_t *chunk);
/* Its chunk that begins at cell `place` [2], packed by kz_pack; cells beyond the ends of the variable are there and have no
 * meaning. */
kz_status kz_store_chunk(kz_store *store, const char *group, const char *name, const int64_t *place, const void *packed,
                         size_t bytes);
/* What the integers of a variable that is there mean, as attributes flag_values (first .. first + n - 1) and flag_meanings (CF: words
 * between blanks). */
kz_status kz_store_flags(kz_store *store, const char *group, const char *name, int32_t first, int64_t n, const char *meanings);
/* Its rows first .. first + n - 1, from the file. */
kz_status kz_store_rows(kz_store *store, const char *group, const char *name, int64_t first, int64_t n, void *data);

/* Writes GROUP/NAME of n values of a type; `expression` gives value i. Returns from the function that it stands in where it
 * fails. */
#define KZ_COLUMN(store, group, name, n, type, expression)                         \
  do {                                                                             \
    const int64_t column_n = (n);                                                  \
    type *column = kz_calloc((size_t)column_n + 1, sizeof *column);                \
    for (int64_t i = 0; i < column_n; i++) column[i] = (type)(expression);         \
    const kz_status column_status = kz_store_variable(store, group, name, column); \
    free(column);                                                                  \
    KZ_TRY(column_status);                                                         \
  } while (0)

/* What a study before has written: the length of a dimension (0 where there is none), and one number of a variable at
 * index [its dimensions]. */
kz_status kz_store_length(kz_store *store, const char *group, const char *dimension, int64_t *length);
kz_status kz_store_number(kz_store *store, const char *group, const char *name, const int64_t *index, double *value);

/* ---- arrays of numbers as HDF5's filters shuffle and deflate pack them; no HDF5 ---- */

/* Bytes that n packed numbers of `item` bytes take at most. */
size_t kz_pack_bytes(size_t n, size_t item);
/* Packs n numbers of `item` bytes, of which neighbours are often equal, into `packed` [kz_pack_bytes]: how many bytes that took, a function of the numbers alone; 0 where
 * zlib has no memory. */
size_t kz_pack_into(const void *numbers, size_t n, size_t item, void *packed);
/* The reverse; false where `packed` [bytes] does not hold n such numbers. */
bool kz_unpack(const void *packed, size_t bytes, size_t n, size_t item, void *numbers);

/* The root attribute `fingerprint` of PATH, to be freed; NULL where PATH is no complete file of this program. */
char *kz_store_fingerprint(const char *path);

#endif
