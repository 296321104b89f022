/* Records on their way to rank 0. */
#include "harvest.h"

#include <stdlib.h>
#include <string.h>

enum { SLOT_HEAD = 16, TAG = 1 };
static const size_t BLOCK_BYTES = (size_t)1 << 22;

struct kz_block {
  kz_block *next;
  int64_t n_slots;
  _Alignas(16) char slots[];
};

void kz_harvest_begin(kz_harvest *harvest, size_t record_bytes) {
  const size_t stride = SLOT_HEAD + (record_bytes + 15) / 16 * 16;
  *harvest = (kz_harvest){.record_bytes = record_bytes, .stride = stride};
  harvest->block_slots = stride < BLOCK_BYTES ? (int64_t)(BLOCK_BYTES / stride) : 1;
}

size_t kz_harvest_message_bytes(const kz_harvest *harvest) {
  return (size_t)harvest->block_slots * harvest->stride;
}

static kz_block *block_with_room(kz_harvest *harvest) {
  if (harvest->last && harvest->last->n_slots < harvest->block_slots) return harvest->last;
  kz_block *block = malloc(sizeof *block + kz_harvest_message_bytes(harvest));
  if (!block) return NULL;
  block->next = NULL;
  block->n_slots = 0;
  if (harvest->last)
    harvest->last->next = block;
  else
    harvest->first = block;
  harvest->last = block;
  ++harvest->n_blocks;
  return block;
}

void *kz_harvest_add(kz_harvest *harvest, int64_t tile) {
  kz_block *block = block_with_room(harvest);
  if (!block) return NULL;
  char *slot = block->slots + (size_t)block->n_slots++ * harvest->stride;
  memset(slot, 0, harvest->stride);
  memcpy(slot, &tile, sizeof tile);
  return slot + SLOT_HEAD;
}

static kz_status send_blocks(const kz_harvest *harvest, kz_team *team) {
  for (const kz_block *block = harvest->first; block; block = block->next)
    KZ_MPI(MPI_Send(block->slots, (int)((size_t)block->n_slots * harvest->stride), MPI_BYTE, 0, TAG, team->comm));
  return KZ_OK;
}

static kz_status receive_block(const kz_harvest *harvest, kz_team *team, int source, char *buffer, char *records) {
  MPI_Status told;
  int bytes;
  KZ_MPI(MPI_Recv(buffer, (int)kz_harvest_message_bytes(harvest), MPI_BYTE, source, TAG, team->comm, &told));
  KZ_MPI(MPI_Get_count(&told, MPI_BYTE, &bytes));
  for (const char *slot = buffer; slot < buffer + bytes; slot += harvest->stride) {
    int64_t tile;
    memcpy(&tile, slot, sizeof tile);
    memcpy(records + (size_t)tile * harvest->record_bytes, slot + SLOT_HEAD, harvest->record_bytes);
  }
  return KZ_OK;
}

kz_status kz_harvest_deliver(const kz_harvest *harvest, kz_team *team, void *buffer, char *records) {
  if (team->rank != 0) {
    KZ_MPI(MPI_Send(&harvest->n_blocks, 1, MPI_INT64_T, 0, TAG, team->comm));
    return send_blocks(harvest, team);
  }
  for (int source = 1; source < team->size; ++source) {
    int64_t n_blocks;
    KZ_MPI(MPI_Recv(&n_blocks, 1, MPI_INT64_T, source, TAG, team->comm, MPI_STATUS_IGNORE));
    for (int64_t i = 0; i < n_blocks; ++i) KZ_TRY(receive_block(harvest, team, source, buffer, records));
  }
  return KZ_OK;
}

void kz_harvest_end(kz_harvest *harvest) {
  while (harvest->first) {
    kz_block *next = harvest->first->next;
    free(harvest->first);
    harvest->first = next;
  }
  harvest->last = NULL;
}
