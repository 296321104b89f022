/* Records that stay in memory: shuffled, without the planes of bytes that are all 0, deflated without a checksum. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "kapitza/store.h"
#include "pack.h"

enum { MOST_PLANES = 32, RAW = -MAX_WBITS };

/* The planes that are not all 0 come to the front; a bit for each of them. */
static uint32_t gather(unsigned char *planes, size_t item, size_t n) {
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

static size_t count(uint32_t used) {
  size_t planes = 0;
  for (; used; used &= used - 1) planes++;
  return planes;
}

static size_t deflate_planes(unsigned char *planes, size_t n, void *packed, size_t most) {
  z_stream stream = {.zalloc = Z_NULL, .zfree = Z_NULL, .opaque = Z_NULL};
  if (n > UINT_MAX / 2 || deflateInit2(&stream, KZ_PACK_LEVEL, Z_DEFLATED, RAW, MAX_MEM_LEVEL, Z_RLE) != Z_OK) return 0;
  stream.next_in = planes;
  stream.avail_in = (uInt)n;
  stream.next_out = packed;
  stream.avail_out = (uInt)most;
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  const size_t bytes = stream.total_out;
  deflateEnd(&stream);
  return whole ? bytes : 0;
}

static bool inflate_planes(const void *packed, size_t bytes, unsigned char *planes, size_t n) {
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

size_t kz_squeeze(const void *items, size_t n, size_t item, void *packed) {
  if (item > MOST_PLANES) return 0;
  unsigned char *planes = kz_malloc(item * n + 1);
  kz_shuffle(items, item, n, planes);
  const uint32_t used = gather(planes, item, n);
  memcpy(packed, &used, sizeof used);
  const size_t most = kz_pack_bytes(n, item) - sizeof used;
  const size_t bytes = deflate_planes(planes, count(used) * n, (char *)packed + sizeof used, most);
  free(planes);
  return bytes > 0 ? sizeof used + bytes : 0;
}

static inline __attribute__((always_inline)) void move_back(const unsigned char *const plane[], size_t n, size_t item,
                                                            unsigned char *restrict items) {
  for (size_t i = 0; i < n; i++)
    for (size_t b = 0; b < item; b++) items[i * item + b] = plane[b][i];
}

bool kz_unsqueeze(const void *packed, size_t bytes, size_t n, size_t item, void *items) {
  uint32_t used;
  if (bytes <= sizeof used || item > MOST_PLANES) return false;
  memcpy(&used, packed, sizeof used);
  const size_t planes = count(used);
  unsigned char *buffer = kz_calloc((planes + 1) * n + 1, 1); /* the last plane is that of zeros */
  const unsigned char *plane[MOST_PLANES];
  size_t next = 0;
  for (size_t b = 0; b < item; b++) plane[b] = buffer + n * (used >> b & 1 ? next++ : planes);
  const bool whole =
      next == planes && inflate_planes((const char *)packed + sizeof used, bytes - sizeof used, buffer, planes * n);
  if (whole && item == 16)
    move_back(plane, n, 16, items); /* labelled cells */
  else if (whole)
    move_back(plane, n, item, items);
  free(buffer);
  return whole;
}
