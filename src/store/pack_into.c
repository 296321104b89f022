/* Packing into a given buffer. */
#include <stdlib.h>
#include <string.h>

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
