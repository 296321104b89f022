#include "dispatch.h"

#include <time.h>

#include "kapitza/common_threads.h"

enum { ASK_TAG = 2, ANSWER_TAG = 3, STACK_BYTES = 1 << 20 };

enum { WORKING, IDLE, FAILED };
typedef struct {
  double seconds; /* Seconds per tile, 0 = not known */
  int64_t state;
} kz_ask;

/* Rank 0 polls with back-off: sleep = idle time / 16, within these bounds. */
static const double SLEEP_SHARE = 1.0 / 16, SHORTEST_SLEEP = 1e-5, LONGEST_SLEEP = 1e-3; /* s */

static double seconds_a_tile(const kz_dispatch *dispatch) {
  return dispatch->n_done > 0 ? dispatch->busy / (double)dispatch->n_done : 0;
}

/* Rank 0: answers one request, except of a rank that cannot go on. */
static int answer_request(kz_dispatch *dispatch, int rank, const kz_ask *ask) {
  kz_grant grant = {0};
  kz_schedule *schedule = &dispatch->schedule;
  if (ask->state == FAILED) dispatch->halted = true;
  kz_schedule_note(schedule, rank, ask->seconds);
  if (!dispatch->halted) grant.n = kz_schedule_grant(schedule, rank, ask->state == WORKING, &grant.first);
  grant.more = !dispatch->halted && schedule->next < schedule->end && (grant.n > 0 || ask->state == WORKING);
  if (!grant.more) --dispatch->will_ask;
  if (ask->state == FAILED) return MPI_SUCCESS;
  return MPI_Send(&grant, sizeof grant, MPI_BYTE, rank, ANSWER_TAG, dispatch->ranks->comm);
}

/* Polls for one request and answers it; *found: there was one. */
static int poll_request(kz_dispatch *dispatch, kz_ask *ask, MPI_Request *request, int *found) {
  MPI_Status from;
  int code = MPI_SUCCESS;
  if (*request == MPI_REQUEST_NULL)
    code = MPI_Irecv(ask, sizeof *ask, MPI_BYTE, MPI_ANY_SOURCE, ASK_TAG, dispatch->ranks->comm, request);
  if (code == MPI_SUCCESS) code = MPI_Test(request, found, &from);
  return code == MPI_SUCCESS && *found ? answer_request(dispatch, from.MPI_SOURCE, ask) : code;
}

static void sleep_between_polls(double idle) {
  const double share = SLEEP_SHARE * idle;
  const double seconds = share < SHORTEST_SLEEP ? SHORTEST_SLEEP : share > LONGEST_SLEEP ? LONGEST_SLEEP : share;
  nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL);
}

/* Rank 0 answers until every other rank knows that nothing is left. */
static void *serve_requests(void *context) {
  kz_dispatch *dispatch = context;
  kz_ask ask;
  MPI_Request request = MPI_REQUEST_NULL;
  double received = kz_clock();
  for (bool more = dispatch->will_ask > 0; more;) {
    int found = 0;
    pthread_mutex_lock(&dispatch->ranks->mutex);
    dispatch->mpi_error = poll_request(dispatch, &ask, &request, &found);
    if (dispatch->mpi_error != MPI_SUCCESS) dispatch->halted = true;
    more = dispatch->will_ask > 0 && dispatch->mpi_error == MPI_SUCCESS;
    pthread_mutex_unlock(&dispatch->ranks->mutex);
    if (found)
      received = kz_clock();
    else
      sleep_between_polls(kz_clock() - received);
  }
  return NULL;
}

static void prepare_dispatch(kz_dispatch *dispatch, kz_ranks *ranks, int64_t n_tiles) {
  *dispatch = (kz_dispatch){.ranks = ranks, .answer = MPI_REQUEST_NULL, .mpi_error = MPI_SUCCESS};
  dispatch->grant = (kz_grant){.first = ranks->rank, .n = ranks->rank < n_tiles, .more = ranks->size < n_tiles};
  if (ranks->rank != 0) return;
  dispatch->will_ask = dispatch->grant.more ? ranks->size - 1 : 0;
  kz_schedule_begin(&dispatch->schedule, n_tiles, ranks->size);
}

void kz_dispatch_begin(kz_dispatch *dispatch, kz_ranks *ranks, int64_t n_tiles) {
  prepare_dispatch(dispatch, ranks, n_tiles);
  if (ranks->rank != 0 || dispatch->will_ask == 0) return;
  dispatch->threaded = ranks->thread_level >= MPI_THREAD_SERIALIZED &&
                       kz_thread_start(&dispatch->thread, STACK_BYTES, serve_requests, dispatch);
  if (!dispatch->threaded)
    serve_requests(dispatch); /* then the others do the work: rank 0 has time for its own once they are done */
}

static kz_status send_request(kz_dispatch *dispatch, int64_t state) {
  const kz_ask ask = {.seconds = seconds_a_tile(dispatch), .state = state};
  kz_ranks *ranks = dispatch->ranks;
  if (state != FAILED)
    KZ_MPI(MPI_Irecv(&dispatch->next, sizeof dispatch->next, MPI_BYTE, 0, ANSWER_TAG, ranks->comm, &dispatch->answer));
  KZ_MPI(MPI_Send(&ask, sizeof ask, MPI_BYTE, 0, ASK_TAG, ranks->comm));
  return KZ_OK;
}

static kz_status take_answer(kz_dispatch *dispatch) {
  KZ_MPI(MPI_Wait(&dispatch->answer, MPI_STATUS_IGNORE));
  dispatch->grant = dispatch->next;
  return KZ_OK;
}

static kz_status next_by_message(kz_dispatch *dispatch, int64_t *tile) {
  kz_grant *grant = &dispatch->grant;
  while (grant->n == 0 && grant->more) {
    if (dispatch->answer == MPI_REQUEST_NULL) KZ_TRY(send_request(dispatch, IDLE));
    KZ_TRY(take_answer(dispatch));
  }
  if (grant->n == 0) return KZ_OK;
  *tile = grant->first++;
  if (--grant->n == 0 && grant->more && dispatch->n_done > 0) return send_request(dispatch, WORKING);
  return KZ_OK;
}

/* Rank 0 takes its tiles one by one: they cost no message. */
static int64_t take_own_tile(kz_dispatch *dispatch) {
  kz_schedule_note(&dispatch->schedule, 0, seconds_a_tile(dispatch));
  if (dispatch->halted) return -1;
  if (dispatch->grant.n == 0) return kz_schedule_take(&dispatch->schedule, 0);
  dispatch->grant.n = 0;
  return dispatch->grant.first;
}

static void next_own_tile(kz_dispatch *dispatch, int64_t *tile) {
  pthread_mutex_lock(&dispatch->ranks->mutex);
  *tile = take_own_tile(dispatch);
  pthread_mutex_unlock(&dispatch->ranks->mutex);
}

kz_status kz_dispatch_next(kz_dispatch *dispatch, int64_t *tile) {
  kz_status status = KZ_OK;
  if (dispatch->handed > 0) {
    dispatch->busy += kz_clock() - dispatch->handed;
    ++dispatch->n_done;
  }
  *tile = -1;
  if (dispatch->ranks->rank == 0)
    next_own_tile(dispatch, tile);
  else
    status = next_by_message(dispatch, tile);
  dispatch->handed = *tile < 0 ? 0 : kz_clock();
  return status;
}

kz_status kz_dispatch_halt(kz_dispatch *dispatch) {
  if (dispatch->ranks->rank == 0) {
    pthread_mutex_lock(&dispatch->ranks->mutex);
    dispatch->halted = true;
    pthread_mutex_unlock(&dispatch->ranks->mutex);
    return KZ_OK;
  }
  if (dispatch->answer != MPI_REQUEST_NULL) KZ_TRY(take_answer(dispatch));
  return dispatch->grant.more ? send_request(dispatch, FAILED) : KZ_OK;
}

kz_status kz_dispatch_end(kz_dispatch *dispatch) {
  if (dispatch->threaded) pthread_join(dispatch->thread, NULL);
  dispatch->threaded = false;
  kz_schedule_end(&dispatch->schedule);
  KZ_MPI(dispatch->mpi_error);
  return KZ_OK;
}
