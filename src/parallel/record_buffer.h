/* Records that a rank keeps until they are delivered to rank 0, some at a time. */
#pragma once

#include "ranks.h"

typedef struct {
  size_t record_bytes;
  size_t stride;         /* bytes of a slot: tile number and record */
  int64_t message_slots; /* slots of a message */
  int64_t n, capacity;
  char *slots; /* [n][stride] */
} kz_record_buffer;

/* Records larger than this do not fit into a message. */
#define KZ_RECORD_MAX ((size_t)1 << 30)

void kz_record_buffer_begin(kz_record_buffer *buffered, size_t record_bytes);
/* Returns zeroed memory for the record of `tile`, aligned for any type, until the next call. */
void *kz_record_buffer_add(kz_record_buffer *buffered, int64_t tile);
/* Bytes of the largest message. */
size_t kz_record_buffer_message_bytes(const kz_record_buffer *buffered);
/* Brings the records of all other ranks to `records` [tile][record_bytes] on rank 0, by way of `buffer`
 * [kz_record_buffer_message_bytes] there. Collective. */
kz_status kz_record_buffer_deliver(const kz_record_buffer *buffered, kz_ranks *ranks, void *buffer, char *records);
void kz_record_buffer_end(kz_record_buffer *buffered);
