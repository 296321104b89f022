/* A chunk of an array as HDF5's filters shuffle and deflate leave it: for H5Dwrite_chunk. Knows no HDF5. */
#ifndef KAPITZA_STORE_PACK_H
#define KAPITZA_STORE_PACK_H

#include <stdbool.h>
#include <stddef.h>

#include "kapitza/common.h"

enum { KZ_PACK_LEVEL = 4 }; /* of deflate; what the file says of it */

/* Packs n items of `item` bytes each: first bytes of all items, second bytes, ..., then deflated. in_runs: neighbours are
 * often equal, as labels are. *packed is freed by the caller. */
kz_status kz_pack(const void *items, size_t item, size_t n, bool in_runs, void **packed, size_t *bytes);

/* Byte b of item i goes to out [item * n] at b n + i. */
void kz_shuffle(const void *items, size_t item, size_t n, unsigned char *out);

#endif
