/* Arrays packed by zlib, as by HDF5's filters shuffle and deflate, or for memory only. */
#include <limits.h>
#include <zlib.h>

#include "kapitza/store.h"

enum { MAX_ITEM_BYTES = 32, RAW = -MAX_WBITS };

/* Moves byte b of item i to place b n + i. */
static inline __attribute__((always_inline)) void shuffle_planes(const unsigned char *items, size_t item, size_t n,
                                                                 unsigned char *restrict out) {
  for (size_t b = 0; b < item; ++b)
    for (size_t i = 0; i < n; ++i) out[b * n + i] = items[i * item + b];
}

/* Returns the shuffled bytes of the items, to be freed. Constant sizes are moved in vectors. */
static unsigned char *shuffle_bytes(const void *items, size_t item, size_t n) {
  unsigned char *out = kz_malloc(item * n + 1);
  if (item == 2)
    shuffle_planes(items, 2, n, out);
  else if (item == 4)
    shuffle_planes(items, 4, n, out);
  else if (item == 16) /* labelled cells */
    shuffle_planes(items, 16, n, out);
  else
    shuffle_planes(items, item, n, out);
  return out;
}

/* Deflates n bytes into packed [most]; returns the number of bytes, 0 if zlib has no memory or they do not fit. */
static size_t deflate_all(unsigned char *in, size_t n, int window_bits, int strategy, void *packed, size_t most) {
  z_stream stream = {.zalloc = Z_NULL, .zfree = Z_NULL, .opaque = Z_NULL};
  if (n > UINT_MAX / 2 ||
      deflateInit2(&stream, KZ_PACK_LEVEL, Z_DEFLATED, window_bits, MAX_MEM_LEVEL, strategy) != Z_OK)
    return 0;
  stream.next_in = in;
  stream.avail_in = (uInt)n;
  stream.next_out = packed;
  stream.avail_out = (uInt)most;
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  const size_t bytes = stream.total_out;
  deflateEnd(&stream);
  return whole ? bytes : 0;
}

size_t kz_pack_bytes(size_t n, size_t item) {
  return n * item + n * item / 8 + 128; /* more than deflate's own bound */
}

/* Searching only for runs, where bytes come in runs, takes half the time and packs better. */
size_t kz_pack_into(const void *numbers, size_t n, size_t item, bool in_runs, void *packed) {
  unsigned char *bytes = shuffle_bytes(numbers, item, n);
  const int strategy = in_runs ? Z_RLE : Z_DEFAULT_STRATEGY;
  const size_t used = deflate_all(bytes, item * n, MAX_WBITS, strategy, packed, kz_pack_bytes(n, item));
  free(bytes);
  if (used == 0) kz_fail(KZ_FAILED, "zlib cannot pack %zu bytes, probably because memory ran out", item * n);
  return used;
}

/* Moves the planes that are not all 0 to the front; returns a bit for each of them. */
static uint32_t gather_planes(unsigned char *planes, size_t item, size_t n) {
  uint32_t used = 0;
  size_t end = 0;
  for (size_t b = 0; b < item; b++) {
    const unsigned char *plane = planes + b * n;
    if (n == 0 || (plane[0] == 0 && memcmp(plane, plane + 1, n - 1) == 0)) continue;
    memmove(planes + end, plane, n);
    end += n;
    used |= UINT32_C(1) << b;
  }
  return used;
}

/* Shuffles, drops the planes of bytes that are all 0, and deflates without a checksum. */
size_t kz_squeeze(const void *items, size_t n, size_t item, void *packed) {
  if (item > MAX_ITEM_BYTES) return 0;
  unsigned char *planes = shuffle_bytes(items, item, n);
  const uint32_t used = gather_planes(planes, item, n);
  const size_t length = (size_t)__builtin_popcount(used) * n, most = kz_pack_bytes(n, item) - sizeof used;
  memcpy(packed, &used, sizeof used);
  const size_t bytes = deflate_all(planes, length, RAW, Z_RLE, (char *)packed + sizeof used, most);
  free(planes);
  return bytes > 0 ? sizeof used + bytes : 0;
}

static bool inflate_all(const void *packed, size_t bytes, unsigned char *planes, size_t n) {
  z_stream stream = {.zalloc = Z_NULL, .zfree = Z_NULL, .opaque = Z_NULL};
  if (n > UINT_MAX / 2 || bytes > UINT_MAX / 2 || inflateInit2(&stream, RAW) != Z_OK) return false;
  stream.next_in = (unsigned char *)packed;
  stream.avail_in = (uInt)bytes;
  stream.next_out = planes;
  stream.avail_out = (uInt)n;
  const bool whole = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.total_out == n;
  inflateEnd(&stream);
  return whole;
}

static inline __attribute__((always_inline)) void unshuffle_planes(const unsigned char *const plane[], size_t n,
                                                                   size_t item, unsigned char *restrict items) {
  for (size_t i = 0; i < n; i++)
    for (size_t b = 0; b < item; b++) items[i * item + b] = plane[b][i];
}

bool kz_unsqueeze(const void *packed, size_t bytes, size_t n, size_t item, void *items) {
  uint32_t used;
  if (bytes <= sizeof used || item > MAX_ITEM_BYTES) return false;
  memcpy(&used, packed, sizeof used);
  const size_t planes = (size_t)__builtin_popcount(used);
  unsigned char *buffer = kz_calloc((planes + 1) * n + 1, 1); /* the last plane is that of zeros */
  const unsigned char *plane[MAX_ITEM_BYTES];
  size_t next = 0;
  for (size_t b = 0; b < item; b++) plane[b] = buffer + n * (used >> b & 1 ? next++ : planes);
  const bool whole =
      next == planes && inflate_all((const char *)packed + sizeof used, bytes - sizeof used, buffer, planes * n);
  if (whole && item == 16)
    unshuffle_planes(plane, n, 16, items); /* labelled cells */
  else if (whole)
    unshuffle_planes(plane, n, item, items);
  free(buffer);
  return whole;
}
