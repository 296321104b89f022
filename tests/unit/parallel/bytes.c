/* The checksum of checkpoints: CRC-64/XZ, in any pieces. */
#include "../../tools/test.h"

#include "bytes.h"

/* The published check value, and that of no bytes. */
TEST(test_published_value) {
  assert_true(kz_bytes_checksum(0, "123456789", 9) == 0x995DC9BBDF1939FAu);
  assert_true(kz_bytes_checksum(0, "", 0) == 0);
}

/* Whole, cut at any place, and byte by byte: the same sum, wherever the bytes lie. */
TEST(test_pieces) {
  enum { N = 100 };
  unsigned char bytes[N + 8];
  for (int i = 0; i < N + 8; ++i) bytes[i] = (unsigned char)(37 * i * i + 11);
  for (int shift = 0; shift < 8; ++shift) {
    const unsigned char *first = bytes + shift;
    const uint64_t whole = kz_bytes_checksum(0, first, N);
    uint64_t single = 0;
    for (int i = 0; i < N; ++i) single = kz_bytes_checksum(single, first + i, 1);
    assert_true(single == whole);
    for (size_t cut = 0; cut <= N; ++cut)
      assert_true(kz_bytes_checksum(kz_bytes_checksum(0, first, cut), first + cut, N - cut) == whole);
  }
}
