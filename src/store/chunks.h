/* Writing a chunked dataset chunk by chunk, packed by kz_pack. */
#ifndef KAPITZA_STORE_CHUNKS_H
#define KAPITZA_STORE_CHUNKS_H

#include "hdf5_call.h"

/* Chunks of whole rows of about 1 MiB, packed; a single row that is longer is cut. Arrays of at most 16 KiB stay whole. */
kz_status kz_chunks_set(hid_t creation, int rank, const hsize_t *lengths, size_t item);

/* Writes `data`, items of `item` bytes of the dataset's own type, into a dataset that is whole or whose chunks kz_chunks_set chose. */
kz_status kz_chunks_write(hid_t dataset, hid_t type, int rank, const hsize_t *lengths, size_t item, const void *data);

#endif
