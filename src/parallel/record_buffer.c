/* Buffer of records for rank 0. */
#include "record_buffer.h"

enum { SLOT_HEAD = 16, TAG = 1 };
static const size_t MESSAGE_BYTES = (size_t)1 << 22;

void kz_record_buffer_begin(kz_record_buffer *buffered, size_t record_bytes) {
  const size_t stride = SLOT_HEAD + (record_bytes + 15) / 16 * 16;
  *buffered = (kz_record_buffer){.record_bytes = record_bytes, .stride = stride};
  buffered->message_slots = stride < MESSAGE_BYTES ? (int64_t)(MESSAGE_BYTES / stride) : 1;
}

size_t kz_record_buffer_message_bytes(const kz_record_buffer *buffered) {
  return (size_t)buffered->message_slots * buffered->stride;
}

void *kz_record_buffer_add(kz_record_buffer *buffered, int64_t tile) {
  buffered->slots = kz_list_reserve(buffered->slots, &buffered->capacity, buffered->n + 1, buffered->stride);
  char *slot = buffered->slots + (size_t)buffered->n++ * buffered->stride;
  memset(slot, 0, buffered->stride);
  memcpy(slot, &tile, sizeof tile);
  return slot + SLOT_HEAD;
}

static kz_status send_slots(const kz_record_buffer *buffered, kz_ranks *ranks) {
  KZ_MPI(MPI_Send(&buffered->n, 1, MPI_INT64_T, 0, TAG, ranks->comm));
  for (int64_t i = 0; i < buffered->n; i += buffered->message_slots) {
    const int64_t left = buffered->n - i, n = kz_smaller(left, buffered->message_slots);
    KZ_MPI(MPI_Send(buffered->slots + (size_t)i * buffered->stride, (int)((size_t)n * buffered->stride), MPI_BYTE, 0,
                    TAG, ranks->comm));
  }
  return KZ_OK;
}

/* Receives one message of a rank. */
static kz_status receive_slots(const kz_record_buffer *buffered, kz_ranks *ranks, int source, char *buffer,
                               char *records) {
  MPI_Status arrived;
  int bytes;
  KZ_MPI(MPI_Recv(buffer, (int)kz_record_buffer_message_bytes(buffered), MPI_BYTE, source, TAG, ranks->comm, &arrived));
  KZ_MPI(MPI_Get_count(&arrived, MPI_BYTE, &bytes));
  for (const char *slot = buffer; slot < buffer + bytes; slot += buffered->stride) {
    int64_t tile;
    memcpy(&tile, slot, sizeof tile);
    memcpy(records + (size_t)tile * buffered->record_bytes, slot + SLOT_HEAD, buffered->record_bytes);
  }
  return KZ_OK;
}

kz_status kz_record_buffer_deliver(const kz_record_buffer *buffered, kz_ranks *ranks, void *buffer, char *records) {
  if (ranks->rank != 0) return send_slots(buffered, ranks);
  for (int source = 1; source < ranks->size; ++source) {
    int64_t n;
    KZ_MPI(MPI_Recv(&n, 1, MPI_INT64_T, source, TAG, ranks->comm, MPI_STATUS_IGNORE));
    for (int64_t i = 0; i < n; i += buffered->message_slots)
      KZ_TRY(receive_slots(buffered, ranks, source, buffer, records));
  }
  return KZ_OK;
}

void kz_record_buffer_end(kz_record_buffer *buffered) {
  free(buffered->slots);
  buffered->slots = NULL;
}
