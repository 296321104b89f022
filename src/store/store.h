/* Fields of a store, and functions that its files share. */
#pragma once

#include <hdf5.h>

#include "kapitza/store.h"

struct kz_store {
  char *path, *part; /* PATH and PATH.part */
  hid_t file;        /* PATH.part */
  const kz_group *groups;
};

/* Returns a status for the failed HDF5 call at `file`, `line`, with the library's own text. */
kz_status kz_hdf5_fail(const char *file, int line);
/* Starts HDF5, which then prints nothing by itself. */
kz_status kz_hdf5_start(void);
/* Status of a call; KZ_HDF5 returns it if the call failed. */
#define KZ_HDF5_STATUS(call) ((call) < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : KZ_OK)
#define KZ_HDF5(call) KZ_TRY(KZ_HDF5_STATUS(call))

/* Opens the group of that name ("/" = root) and creates it if necessary; the caller closes it. */
kz_status kz_store_group(kz_store *store, const char *group, hid_t *opened);
/* Reads the length of a dimension. */
kz_status kz_scale_length(hid_t scale, int64_t *length);

/* Write an attribute of an open object. */
kz_status kz_attribute_text(hid_t object, const char *name, const char *value);
kz_status kz_attribute_array(hid_t object, const char *name, hid_t type, hsize_t n, const void *values);
/* Makes the type of variable-length UTF-8; the caller closes it. */
kz_status kz_text_type(hid_t *type);
/* Returns the text of an attribute, to be freed; NULL if there is none. */
char *kz_attribute_read_text(hid_t object, const char *name);

/* Sets chunks and filters of a new dataset: chunks of `chunk` items; NULL: packed rows of about 1 MiB, longer single
 * rows are cut, arrays of at most 16 KiB stay whole. */
kz_status kz_chunks_set(hid_t creation, int rank, const hsize_t *lengths, const hsize_t *chunk, size_t item);
/* Writes `data`, items of `item` bytes of the dataset's own type, into a dataset whose chunks kz_chunks_set chose. */
kz_status kz_chunks_write(hid_t dataset, hid_t type, int rank, const hsize_t *lengths, size_t item, const void *data);
