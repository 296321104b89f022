/* Complete reads and writes at an offset of a file, and checksums. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Writes all bytes; 0, or -1 with errno. */
int kz_bytes_write(int file, const void *bytes, size_t n, int64_t offset);
/* Reads up to n bytes; returns their number, less at the end of the file, or -1 with errno. */
int64_t kz_bytes_read(int file, void *bytes, size_t n, int64_t offset);
/* CRC-64/XZ of the bytes, continued from `sum` (0 to begin). */
uint64_t kz_bytes_checksum(uint64_t sum, const void *bytes, size_t n);
