/* Packing into a given buffer, and the reverse. */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "kapitza/store.h"
#include "pack.h"

size_t kz_pack_bytes(size_t n, size_t item) {
  return n * item + n * item / 8 + 128; /* more than deflate's own bound */
}

size_t kz_pack_into(const void *numbers, size_t n, size_t item, void *packed) {
  void *made;
  size_t bytes;
  if (kz_pack(numbers, item, n, true, &made, &bytes) != KZ_OK) return 0;
  const bool fits = bytes <= kz_pack_bytes(n, item);
  if (fits) memcpy(packed, made, bytes);
  free(made);
  return fits ? bytes : 0;
}

static inline __attribute__((always_inline)) void move_back(const unsigned char *shuffled, size_t n, size_t item,
                                                            unsigned char *restrict out) {
  for (size_t i = 0; i < n; i++)
    for (size_t b = 0; b < item; b++) out[i * item + b] = shuffled[b * n + i];
}

bool kz_unpack(const void *packed, size_t bytes, size_t n, size_t item, void *numbers) {
  unsigned char *out = numbers, *shuffled = kz_malloc(n * item + 1);
  uLongf unpacked = n * item;
  const bool whole = uncompress(shuffled, &unpacked, packed, bytes) == Z_OK && unpacked == n * item;
  if (whole && item == 16)
    move_back(shuffled, n, 16, out); /* labelled cells: in vectors */
  else if (whole)
    move_back(shuffled, n, item, out);
  free(shuffled);
  return whole;
}
