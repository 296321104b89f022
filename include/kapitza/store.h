/* The result file (HDF5, readable as netCDF-4; above common). Tables that the caller gives state the name, type, units
 * and long name of every dataset. One rank writes the file, with the serial library.
 *
 * The file is written as PATH.part and renamed to PATH when it is complete. */
#pragma once

#include "kapitza/common.h"

typedef struct kz_store kz_store;

enum { KZ_MAX_DIMENSIONS = 3, KZ_MAX_FLAGS = 16 };

typedef enum { KZ_REAL, KZ_INT8, KZ_UINT8, KZ_INT16, KZ_INT32, KZ_UINT32, KZ_TEXT } kz_kind;

typedef struct {
  const char *name; /* Name; "#" at its end stands for a number */
  kz_kind kind;
  const char *dimensions[KZ_MAX_DIMENSIONS + 1]; /* Dimensions, NULL-ended; a scale is its own */
  /* Units "@NAME": the group's attribute NAME, written before; "1|WORDS": unit 1 of UDUNITS, and ", in WORDS" is added
   * to the long name. */
  const char *units, *long_name;
  const char *flags[KZ_MAX_FLAGS + 1]; /* Meanings of 0, 1, 2, ...; NULL-ended */
  const char *group;                   /* Group of the variable; NULL = group of its table */
} kz_variable;

/* A group of the file and its variables, of which the last has no name. */
typedef struct {
  const char *name;
  const kz_variable *variables;
} kz_group;

/* Name and version of the HDF5 library. */
const char *kz_store_library(void);

/* Mark of the unfinished file of a killed run in its first 8 KiB. */
#define KZ_STORE_UNFINISHED "an unfinished result of kapitza"
/* Creates PATH.part for the variables of `groups`, of which the last has no name. KZ_REFUSED if it cannot be
 * written. */
kz_status kz_store_create(const char *path, const kz_group *groups, kz_store **store);
/* Returns PATH. */
const char *kz_store_path(const kz_store *store);
/* Flushes and closes the file, and renames it to PATH (fsync before the rename). Frees the store in every case. After a
 * failure (KZ_FAILED, as on a full disk) neither PATH nor PATH.part is left. */
kz_status kz_store_complete(kz_store *store);
/* Closes and removes PATH.part, and frees the store. NULL: does nothing. */
void kz_store_discard(kz_store *store);

/* Write an attribute of a group ("/" = root, "basin" or "/basin"). Text may have any length, also over 64 KiB. */
kz_status kz_store_text(kz_store *store, const char *group, const char *name, const char *arrange_value);
kz_status kz_store_real(kz_store *store, const char *group, const char *name, double arrange_value);
kz_status kz_store_integer(kz_store *store, const char *group, const char *name, int64_t cubic_value);

/* Writes a dimension of a group as its scale variable. `values` [length] have the type that the table gives to the
 * variable of that name; NULL = 0, 1, 2, ... */
kz_status kz_store_dimension(kz_store *store, const char *group, const char *name, int64_t length, const void *values);

/* Writes a whole variable of the table. Its dimensions must have been written before. `data` is an array of the type in
 * the table: double, int8_t, uint8_t, int16_t, int32_t, uint32_t or const char *. */
kz_status kz_store_variable(kz_store *store, const char *group, const char *name, const void *data);

/* Begins a variable of two dimensions whose chunks come one by one; `chunk` [2] = cells of a chunk on each axis. */
kz_status kz_store_chunked(kz_store *store, const char *group, const char *name, const int64_t *chunk);
/* Writes the chunk that begins at cell `place` [2], packed by kz_pack_into. A chunk at the edge also contains the cells
 * beyond the variable, which have no meaning. */
kz_status kz_store_chunk(kz_store *store, const char *group, const char *name, const int64_t *place, const void *packed,
                         size_t bytes);
/* Writes the meanings `text` of the integers low .. low + n - 1 of an existing variable, as attributes flag_values
 * and flag_meanings (CF: words separated by blanks). */
kz_status kz_store_flags(kz_store *file, const char *group, const char *name, int32_t low, int64_t n, const char *text);
/* Sets the attribute _FillValue of a variable of integers: the number that stands for a missing one. */
kz_status kz_store_missing(kz_store *store, const char *group, const char *name, int32_t value);
/* Reads rows first .. first + n - 1 of a variable from the file. */
kz_status kz_store_rows(kz_store *store, const char *group, const char *name, int64_t first, int64_t n, void *data);

/* Write the variable GROUP/NAME of n values of a type, or the dimension of n reals; `expression` gives value i. If that
 * fails, the calling function returns the status. */
#define KZ_COLUMN(store, group, name, n, type, expression) \
  KZ_WITH_COLUMN(n, type, expression, kz_store_variable(store, group, name, column))
#define KZ_SCALE(store, group, name, n, expression) \
  KZ_WITH_COLUMN(n, double, expression, kz_store_dimension(store, group, name, column_n, column))
#define KZ_WITH_COLUMN(n, type, expression, write)                              \
  do {                                                                          \
    const int64_t column_n = (n);                                               \
    KZ_AUTOFREE type *column = kz_calloc((size_t)column_n + 1, sizeof *column); \
    for (int64_t i = 0; i < column_n; i++) column[i] = (type)(expression);      \
    KZ_TRY(write);                                                              \
  } while (0)

/* Read the length of a dimension (0 if there is none), and the number of a variable at `index` [its dimensions]. */
kz_status kz_store_length(kz_store *store, const char *group, const char *dimension, int64_t *length);
kz_status kz_store_number(kz_store *store, const char *group, const char *name, const int64_t *index, double *value);

/* Returns the root attribute `fingerprint` of PATH, to be freed; NULL if PATH is no complete file of this program. */
char *kz_store_fingerprint(const char *path);
/* Opens a complete file of this program for reading; kz_store_discard closes it. KZ_REFUSED if PATH is none. */
kz_status kz_store_open(const char *path, kz_store **store);
/* Returns a text attribute of the root, to be freed; NULL if there is none. */
char *kz_store_text_of(const kz_store *store, const char *name);
/* Reads all numbers of a variable, of which there must be n. */
kz_status kz_store_numbers(kz_store *store, const char *group, const char *name, int64_t n, double *value);

/* ---- arrays of numbers as HDF5's filters shuffle and deflate pack them; no HDF5 ---- */

enum { KZ_PACK_LEVEL = 4 }; /* Level of deflate, which the file states */
/* The largest number of bytes that n packed numbers of `item` bytes each can take. */
size_t kz_pack_bytes(size_t n, size_t item);
/* Packs n numbers of `item` bytes each into `packed` [kz_pack_bytes]; in_runs: neighbours are often equal, as labels
 * are. Returns the number of bytes, which depends on the numbers only; 0, with a message, if zlib has no memory. */
size_t kz_pack_into(const void *numbers, size_t n, size_t item, bool in_runs, void *packed);

/* Packs n items of at most 32 bytes each, many of them 0, into `packed` [kz_pack_bytes], faster but for memory only.
 * Returns as kz_pack_into. */
size_t kz_squeeze(const void *items, size_t n, size_t item, void *packed);
/* Unpacks kz_squeeze to items [n]; false if `packed` [bytes] does not contain n such items. */
bool kz_unsqueeze(const void *packed, size_t bytes, size_t n, size_t item, void *items);
