/* Records on their way to rank 0. */
#include "record_buffer.h"

#include <stdlib.h>
#include <string.h>

enum { SLOT_HEAD = 16, TAG = 1 };
static const size_t BLOCK_BYTES = (size_t)1 << 22;

struct kz_block {
  kz_block *next;
  int64_t n_slots;
  _Alignas(16) char slots[];
};

void kz_record_buffer_begin(kz_record_buffer *buffered, size_t record_bytes) {
  const size_t stride = SLOT_HEAD + (record_bytes + 15) / 16 * 16;
  *buffered = (kz_record_buffer){.record_bytes = record_bytes, .stride = stride};
  buffered->block_slots = stride < BLOCK_BYTES ? (int64_t)(BLOCK_BYTES / stride) : 1;
}

size_t kz_record_buffer_message_bytes(const kz_record_buffer *buffered) {
  return (size_t)buffered->block_slots * buffered->stride;
}

static kz_block *block_with_room(kz_record_buffer *buffered) {
  if (buffered->last && buffered->last->n_slots < buffered->block_slots) return buffered->last;
  kz_block *block = kz_malloc(sizeof *block + kz_record_buffer_message_bytes(buffered));
  block->next = NULL;
  block->n_slots = 0;
  if (buffered->last)
    buffered->last->next = block;
  else
    buffered->first = block;
  buffered->last = block;
  ++buffered->n_blocks;
  return block;
}

void *kz_record_buffer_add(kz_record_buffer *buffered, int64_t tile) {
  kz_block *block = block_with_room(buffered);
  char *slot = block->slots + (size_t)block->n_slots++ * buffered->stride;
  memset(slot, 0, buffered->stride);
  memcpy(slot, &tile, sizeof tile);
  return slot + SLOT_HEAD;
}

static kz_status send_blocks(const kz_record_buffer *buffered, kz_ranks *ranks) {
  for (const kz_block *block = buffered->first; block; block = block->next)
    KZ_MPI(MPI_Send(block->slots, (int)((size_t)block->n_slots * buffered->stride), MPI_BYTE, 0, TAG, ranks->comm));
  return KZ_OK;
}

static kz_status receive_block(const kz_record_buffer *buffered, kz_ranks *ranks, int source, char *buffer, char *records) {
  MPI_Status told;
  int bytes;
  KZ_MPI(MPI_Recv(buffer, (int)kz_record_buffer_message_bytes(buffered), MPI_BYTE, source, TAG, ranks->comm, &told));
  KZ_MPI(MPI_Get_count(&told, MPI_BYTE, &bytes));
  for (const char *slot = buffer; slot < buffer + bytes; slot += buffered->stride) {
    int64_t tile;
    memcpy(&tile, slot, sizeof tile);
    memcpy(records + (size_t)tile * buffered->record_bytes, slot + SLOT_HEAD, buffered->record_bytes);
  }
  return KZ_OK;
}

kz_status kz_record_buffer_deliver(const kz_record_buffer *buffered, kz_ranks *ranks, void *buffer, char *records) {
  if (ranks->rank != 0) {
    KZ_MPI(MPI_Send(&buffered->n_blocks, 1, MPI_INT64_T, 0, TAG, ranks->comm));
    return send_blocks(buffered, ranks);
  }
  for (int source = 1; source < ranks->size; ++source) {
    int64_t n_blocks;
    KZ_MPI(MPI_Recv(&n_blocks, 1, MPI_INT64_T, source, TAG, ranks->comm, MPI_STATUS_IGNORE));
    for (int64_t i = 0; i < n_blocks; ++i) KZ_TRY(receive_block(buffered, ranks, source, buffer, records));
  }
  return KZ_OK;
}

void kz_record_buffer_end(kz_record_buffer *buffered) {
  while (buffered->first) {
    kz_block *next = buffered->first->next;
    free(buffered->first);
    buffered->first = next;
  }
  buffered->last = NULL;
}
