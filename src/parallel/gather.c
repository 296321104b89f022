/* Delivery of records of varying length to rank 0. */
#include "kapitza/parallel.h"

/* Receiver of messages, each the number of a tile and its record. */
typedef struct {
  kz_take_fn take;
  void *context;
} gather_context;

static kz_status make_message(void *context, const kz_local_record *piece, void *message, size_t *bytes) {
  (void)context;
  memcpy(message, &piece->tile, sizeof piece->tile);
  memcpy((char *)message + sizeof piece->tile, piece->data, piece->bytes);
  *bytes = sizeof piece->tile + piece->bytes;
  return KZ_OK;
}

static kz_status take_message(void *context, const void *message, size_t bytes) {
  const gather_context *g = context;
  int64_t tile;
  memcpy(&tile, message, sizeof tile);
  return g->take(g->context, tile, (const char *)message + sizeof tile, bytes - sizeof tile);
}

kz_status kz_stage_gather(const kz_run *run, const kz_stage *stage, const char *name, kz_take_fn take_record,
                          void *context) {
  kz_local_records pieces = {0};
  kz_stage own = *stage;
  gather_context g = {take_record, context};
  const kz_delivery delivery = {.name = name,
                                .message_bytes = stage->record_bytes + sizeof(int64_t),
                                .make = make_message,
                                .take = take_message,
                                .context = &g};
  own.local = &pieces;
  kz_status status = kz_stage_run(run, &own, NULL);
  if (status == KZ_OK) status = kz_local_records_deliver(run, &pieces, &delivery);
  kz_local_records_free(&pieces);
  return status;
}
