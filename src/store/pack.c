#include "pack.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

/* Byte b of item i goes to place b n + i. */
static inline __attribute__((always_inline)) void move_bytes(const unsigned char *items, size_t item, size_t n,
                                                             unsigned char *restrict out) {
  for (size_t b = 0; b < item; ++b)
    for (size_t i = 0; i < n; ++i) out[b * n + i] = items[i * item + b];
}

/* Sizes that are known beforehand are moved in vectors. */
void kz_shuffle(const void *items, size_t item, size_t n, unsigned char *out) {
  if (item == 2)
    move_bytes(items, 2, n, out);
  else if (item == 4)
    move_bytes(items, 4, n, out);
  else if (item == 16) /* labelled cells */
    move_bytes(items, 16, n, out);
  else
    move_bytes(items, item, n, out);
}

/* Where bytes come in runs, looking for nothing else takes half the time and packs better. */
static kz_status deflate_all(unsigned char *in, size_t n, int strategy, void **packed, size_t *bytes) {
  z_stream stream = {.zalloc = Z_NULL, .zfree = Z_NULL, .opaque = Z_NULL};
  if (n > UINT_MAX / 2 || deflateInit2(&stream, KZ_PACK_LEVEL, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, strategy) != Z_OK)
    return kz_fail(KZ_FAILED, "zlib cannot pack %zu bytes, probably because memory ran out", n);
  *bytes = deflateBound(&stream, n);
  *packed = kz_malloc(*bytes);
  stream.next_in = in;
  stream.avail_in = (uInt)n;
  stream.next_out = *packed;
  stream.avail_out = (uInt)*bytes;
  const int done = deflate(&stream, Z_FINISH);
  *bytes = stream.total_out;
  deflateEnd(&stream);
  if (done == Z_STREAM_END) return KZ_OK;
  free(*packed);
  *packed = NULL;
  return kz_fail(KZ_FAILED, "zlib cannot pack %zu bytes", n);
}

kz_status kz_pack(const void *items, size_t item, size_t n, bool in_runs, void **packed, size_t *bytes) {
  unsigned char *shuffled = kz_malloc(item * n + 1);
  *packed = NULL;
  kz_shuffle(items, item, n, shuffled);
  const kz_status status = deflate_all(shuffled, item * n, in_runs ? Z_RLE : Z_DEFAULT_STRATEGY, packed, bytes);
  free(shuffled);
  return status;
}
