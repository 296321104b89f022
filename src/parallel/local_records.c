/* Records of varying length, which stay on the ranks that made them until they become messages for rank 0. */
#include "watch.h"

enum { TAG = 4, END = 5, BUFFERS = 4 };
static const size_t MESSAGE_MAX = (size_t)1 << 30;

void kz_local_records_add(kz_local_records *records, int64_t tile, const void *data, size_t bytes) {
  records->list = kz_list_reserve(records->list, &records->capacity, records->n + 1, sizeof *records->list);
  void *copy = kz_malloc(bytes + 1);
  records->list[records->n++] = (kz_local_record){tile, bytes, memcpy(copy, data, bytes)};
}

void kz_local_records_free(kz_local_records *records) {
  for (int64_t i = 0; i < records->n; i++) free(records->list[i].data);
  free(records->list);
  *records = (kz_local_records){0};
}

typedef struct {
  kz_ranks *ranks;
  const kz_delivery *delivery;
  const kz_local_records *records;
  char *buffer[BUFFERS + 1];        /* [message_bytes]; the last is for rank 0's own records */
  MPI_Request request[BUFFERS + 1]; /* Pending messages; last, on rank 0: the end of a rank's messages */
  int64_t sent;                     /* Number of messages of the rank that has ended; rank 0 */
  int ended;                        /* Number of ranks that have sent all; rank 0 */
  int64_t expected, received;       /* Messages of ranks that have ended; of all; rank 0 */
  int64_t done;
  char take_name[40];
  kz_work make_work, take_work;
  kz_meter meter;
} delivery_context;

static kz_status make_message(delivery_context *m, int64_t i, char *buffer, size_t *bytes) {
  const kz_stopwatch watch = kz_stopwatch_start();
  const kz_status status = m->delivery->make(m->delivery->context, &m->records->list[i], buffer, bytes);
  kz_work_note(&m->make_work, m->records->list[i].tile, &watch);
  return status;
}

static kz_status take_message(delivery_context *m, const char *buffer, size_t bytes) {
  const kz_stopwatch watch = kz_stopwatch_start();
  const kz_status status = m->delivery->take(m->delivery->context, buffer, bytes);
  kz_work_note(&m->take_work, m->done, &watch);
  return status;
}

/* Makes and sends messages, and tests pending ones in between, without which some transports would not move them. */
static kz_status send_records(delivery_context *m) {
  kz_status status = KZ_OK;
  int64_t i = 0;
  for (; i < m->records->n; i++) {
    const int slot = (int)(i % BUFFERS);
    size_t bytes = 0;
    int all;
    KZ_MPI(MPI_Wait(&m->request[slot], MPI_STATUS_IGNORE));
    if ((status = kz_ranks_interrupted(m->ranks)) != KZ_OK) break;
    if ((status = make_message(m, i, m->buffer[slot], &bytes)) != KZ_OK) break;
    KZ_MPI(MPI_Isend(m->buffer[slot], (int)bytes, MPI_BYTE, 0, TAG, m->ranks->comm, &m->request[slot]));
    KZ_MPI(MPI_Testall(BUFFERS, m->request, &all, MPI_STATUSES_IGNORE));
  }
  KZ_MPI(MPI_Waitall(BUFFERS, m->request, MPI_STATUSES_IGNORE));
  KZ_MPI(MPI_Send(&i, 1, MPI_INT64_T, 0, END, m->ranks->comm));
  return status;
}

/* Rank 0: posts the receive of the next message, or of the number that the next rank has sent. */
static kz_status expect_message(delivery_context *m, int slot) {
  MPI_Request *request = &m->request[slot];
  if (slot < BUFFERS)
    KZ_MPI(MPI_Irecv(m->buffer[slot], (int)m->delivery->message_bytes, MPI_BYTE, MPI_ANY_SOURCE, TAG, m->ranks->comm,
                     request));
  else if (m->ended < m->ranks->size - 1)
    KZ_MPI(MPI_Irecv(&m->sent, 1, MPI_INT64_T, MPI_ANY_SOURCE, END, m->ranks->comm, request));
  return KZ_OK;
}

/* Takes an arrived message; after a failure further messages are dropped. */
static kz_status receive_message(delivery_context *m, int slot, const MPI_Status *come, kz_status *status) {
  int bytes;
  if (slot == BUFFERS) {
    m->expected += m->sent;
    m->ended++;
    return expect_message(m, slot);
  }
  KZ_MPI(MPI_Get_count(come, MPI_BYTE, &bytes));
  if (*status == KZ_OK) *status = take_message(m, m->buffer[slot], (size_t)bytes);
  m->received++;
  kz_meter_show(&m->meter, ++m->done);
  return expect_message(m, slot);
}

static kz_status receive_waiting(delivery_context *m, kz_status *status) {
  MPI_Status come;
  int slot, is_there;
  for (;;) {
    KZ_MPI(MPI_Testany(BUFFERS + 1, m->request, &slot, &is_there, &come));
    if (!is_there || slot == MPI_UNDEFINED) return KZ_OK;
    KZ_TRY(receive_message(m, slot, &come, status));
  }
}

static kz_status receive_rest(delivery_context *m, kz_status *status) {
  MPI_Status come;
  int slot;
  while (m->ended < m->ranks->size - 1 || m->received < m->expected) {
    KZ_MPI(MPI_Waitany(BUFFERS + 1, m->request, &slot, &come));
    KZ_TRY(receive_message(m, slot, &come, status));
  }
  for (slot = 0; slot < BUFFERS; slot++) {
    KZ_MPI(MPI_Cancel(&m->request[slot]));
    KZ_MPI(MPI_Wait(&m->request[slot], MPI_STATUS_IGNORE));
  }
  return KZ_OK;
}

/* Rank 0: takes arrived messages between two records of its own. */
static kz_status take_records(delivery_context *m) {
  kz_status status = KZ_OK;
  const bool several = kz_ranks_several(m->ranks);
  for (int slot = 0; several && slot <= BUFFERS; slot++) KZ_TRY(expect_message(m, slot));
  for (int64_t i = 0; i < m->records->n && status == KZ_OK; i++) {
    size_t bytes = 0;
    if ((status = kz_ranks_interrupted(m->ranks)) != KZ_OK) break;
    status = make_message(m, i, m->buffer[BUFFERS], &bytes);
    if (status == KZ_OK) status = take_message(m, m->buffer[BUFFERS], bytes);
    kz_meter_show(&m->meter, ++m->done);
    if (several) KZ_TRY(receive_waiting(m, &status));
  }
  if (several) KZ_TRY(receive_rest(m, &status));
  return status;
}

static kz_status local_records_allocate(delivery_context *m) {
  const int first = m->ranks->size == 1 ? BUFFERS : 0, end = m->ranks->rank == 0 ? BUFFERS + 1 : BUFFERS;
  for (int i = first; i < end; i++) m->buffer[i] = kz_malloc(m->delivery->message_bytes + 1);
  if (m->delivery->message_bytes <= MESSAGE_MAX) return KZ_OK;
  return kz_fail(KZ_FAILED, "stage %s: messages of %zu bytes are too long", m->delivery->name,
                 m->delivery->message_bytes);
}

static kz_status deliver_records(delivery_context *m, int64_t total) {
  double idle = 0;
  kz_ranks *ranks = m->ranks;
  snprintf(m->take_name, sizeof m->take_name, "%s: writing", m->delivery->name);
  m->make_work = (kz_work){.ranks = ranks, .stage = m->delivery->name};
  m->take_work = (kz_work){.ranks = ranks, .stage = m->take_name};
  const kz_stopwatch watch = kz_stopwatch_start();
  kz_meter_begin(&m->meter, ranks, m->delivery->name, total, 0);
  kz_status status = kz_ranks_agree(ranks, ranks->rank == 0 ? take_records(m) : send_records(m));
  kz_work_end(&m->make_work);
  kz_work_end(&m->take_work);
  m->make_work.busy += m->take_work.busy;
  m->make_work.processor += m->take_work.processor;
  if (status == KZ_OK) status = kz_timing_note(ranks, total, &watch, &m->make_work, &idle);
  kz_meter_end(&m->meter, status == KZ_OK, idle);
  return status;
}

/* Delivers without ranks: each record becomes a message that is taken at once. */
static kz_status deliver_alone(const kz_local_records *records, const kz_delivery *delivery) {
  KZ_AUTOFREE char *message = kz_malloc(delivery->message_bytes + 1);
  kz_status status = KZ_OK;
  for (int64_t i = 0; i < records->n && status == KZ_OK; i++) {
    size_t bytes = 0;
    status = delivery->make(delivery->context, records->list + i, message, &bytes);
    if (status == KZ_OK) status = delivery->take(delivery->context, message, bytes);
  }
  return status;
}

kz_status kz_local_records_deliver(const kz_run *run, const kz_local_records *records, const kz_delivery *delivery) {
  if (!run || !run->ranks) return deliver_alone(records, delivery);
  kz_ranks *ranks = run->ranks;
  delivery_context m = {.ranks = ranks, .delivery = delivery, .records = records};
  for (int i = 0; i <= BUFFERS; i++) m.request[i] = MPI_REQUEST_NULL;
  int64_t total = records->n;
  kz_status status = kz_ranks_agree(ranks, local_records_allocate(&m));
  if (status == KZ_OK) status = kz_ranks_sum(ranks, &total, 1);
  if (status == KZ_OK) status = deliver_records(&m, total);
  for (int i = 0; i <= BUFFERS; i++) free(m.buffer[i]);
  return status;
}
