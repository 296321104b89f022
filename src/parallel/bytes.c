#include "bytes.h"

#include <errno.h>
#include <pthread.h>
#include <unistd.h>

int kz_bytes_write(int file, const void *bytes, size_t n, int64_t offset) {
  for (size_t done = 0; done < n;) {
    const ssize_t written = pwrite(file, (const char *)bytes + done, n - done, (off_t)(offset + (int64_t)done));
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC;
    if (written <= 0) return -1;
    done += (size_t)written;
  }
  return 0;
}

int64_t kz_bytes_read(int file, void *bytes, size_t n, int64_t offset) {
  size_t done = 0;
  while (done < n) {
    const ssize_t got = pread(file, (char *)bytes + done, n - done, (off_t)(offset + (int64_t)done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += (size_t)got;
  }
  return (int64_t)done;
}

/* The reflected polynomial of ECMA-182. */
static const uint64_t POLYNOMIAL = 0xC96C5795D7870F42u;

enum { SLICES = 8 };

/* table[k][b]: contribution of byte b, with k bytes after it, to the sum. */
static uint64_t table[SLICES][256];

static void fill_table(void) {
  for (uint64_t byte = 0; byte < 256; ++byte) {
    uint64_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = value & 1 ? value >> 1 ^ POLYNOMIAL : value >> 1;
    table[0][byte] = value;
  }
  for (int k = 1; k < SLICES; ++k)
    for (int byte = 0; byte < 256; ++byte)
      table[k][byte] = table[0][table[k - 1][byte] & 255] ^ table[k - 1][byte] >> 8;
}

/* Eight bytes at a time (slicing by 8: Kounavis and Berry, IEEE Trans. Comput. 57 (2008) 1550). */
uint64_t kz_bytes_checksum(uint64_t sum, const void *bytes, size_t n) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, fill_table);
  const unsigned char *byte = bytes;
  sum = ~sum;
  for (; n >= SLICES; n -= SLICES, byte += SLICES) {
    uint64_t next = 0;
#pragma GCC unroll 8
    for (int k = 0; k < SLICES; ++k) next ^= table[SLICES - 1 - k][(sum >> 8 * k ^ byte[k]) & 255];
    sum = next;
  }
  for (size_t i = 0; i < n; ++i) sum = table[0][(sum ^ byte[i]) & 255] ^ sum >> 8;
  return ~sum;
}
