#include "dispatch.h"

#include <signal.h>
#include <time.h>

enum { ASK_TAG = 2, ANSWER_TAG = 3, STACK_BYTES = 1 << 20 };

enum { WORKING, IDLE, FAILED };
typedef struct {
  double seconds; /* for a tile, 0 = not known */
  int64_t state;
} kz_ask;

/* Between two looks for messages rank 0 sleeps for a sixteenth of the time in which none came. */
static const double QUIET_SHARE = 1.0 / 16, SHORTEST = 1e-5, LONGEST = 1e-3; /* s */

static double seconds_a_tile(const kz_dispatch *draw) {
  return draw->n_done > 0 ? draw->busy / (double)draw->n_done : 0;
}

/* Rank 0: the answer to one request; nothing goes back to a rank that cannot go on. */
static int answer(kz_dispatch *draw, int rank, const kz_ask *ask) {
  kz_batch batch = {0};
  kz_schedule *schedule = &draw->schedule;
  if (ask->state == FAILED) draw->halted = true;
  kz_schedule_note(schedule, rank, ask->seconds);
  if (!draw->halted) batch.n = kz_schedule_grant(schedule, rank, ask->state == WORKING, &batch.first);
  batch.more = !draw->halted && schedule->next < schedule->end && (batch.n > 0 || ask->state == WORKING);
  if (!batch.more) --draw->asking;
  if (ask->state == FAILED) return MPI_SUCCESS;
  return MPI_Send(&batch, sizeof batch, MPI_BYTE, rank, ANSWER_TAG, draw->ranks->comm);
}

/* Looks for one request; *found: there was one. */
static int look(kz_dispatch *draw, kz_ask *ask, MPI_Request *request, int *found) {
  MPI_Status from;
  int code = MPI_SUCCESS;
  if (*request == MPI_REQUEST_NULL)
    code = MPI_Irecv(ask, sizeof *ask, MPI_BYTE, MPI_ANY_SOURCE, ASK_TAG, draw->ranks->comm, request);
  if (code == MPI_SUCCESS) code = MPI_Test(request, found, &from);
  return code == MPI_SUCCESS && *found ? answer(draw, from.MPI_SOURCE, ask) : code;
}

static void rest(double quiet) {
  const double share = QUIET_SHARE * quiet;
  const double seconds = share < SHORTEST ? SHORTEST : share > LONGEST ? LONGEST : share;
  nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL);
}

/* Rank 0 answers until every other rank knows that nothing is left. */
static void *serve(void *context) {
  kz_dispatch *draw = context;
  kz_ask ask;
  MPI_Request request = MPI_REQUEST_NULL;
  double heard = kz_clock();
  for (bool more = draw->asking > 0; more;) {
    int found = 0;
    pthread_mutex_lock(&draw->ranks->mutex);
    draw->mpi_error = look(draw, &ask, &request, &found);
    if (draw->mpi_error != MPI_SUCCESS) draw->halted = true;
    more = draw->asking > 0 && draw->mpi_error == MPI_SUCCESS;
    pthread_mutex_unlock(&draw->ranks->mutex);
    if (found)
      heard = kz_clock();
    else
      rest(kz_clock() - heard);
  }
  return NULL;
}

/* Signals are for the thread that works. */
static bool start_thread(kz_dispatch *draw) {
  pthread_attr_t attributes;
  sigset_t all, before;
  if (draw->ranks->thread_level < MPI_THREAD_SERIALIZED || pthread_attr_init(&attributes) != 0) return false;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const bool started =
      pthread_attr_setstacksize(&attributes, STACK_BYTES) == 0 && pthread_create(&draw->thread, &attributes, serve, draw) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  pthread_attr_destroy(&attributes);
  return started;
}

void kz_dispatch_prepare(kz_dispatch *draw, kz_ranks *ranks, int64_t n_tiles) {
  *draw = (kz_dispatch){.ranks = ranks, .answer = MPI_REQUEST_NULL, .mpi_error = MPI_SUCCESS};
  draw->batch = (kz_batch){.first = ranks->rank, .n = ranks->rank < n_tiles, .more = ranks->size < n_tiles};
  if (ranks->rank != 0) return;
  draw->asking = draw->batch.more ? ranks->size - 1 : 0;
  kz_schedule_begin(&draw->schedule, n_tiles, ranks->size);
}

void kz_dispatch_begin(kz_dispatch *draw) {
  if (draw->ranks->rank != 0 || draw->asking == 0) return;
  draw->threaded = start_thread(draw);
  if (!draw->threaded) serve(draw); /* then the others do the work: rank 0 has time for its own once they are done */
}

static kz_status ask(kz_dispatch *draw, int64_t state) {
  const kz_ask ask = {.seconds = seconds_a_tile(draw), .state = state};
  kz_ranks *ranks = draw->ranks;
  if (state != FAILED)
    KZ_MPI(MPI_Irecv(&draw->granted, sizeof draw->granted, MPI_BYTE, 0, ANSWER_TAG, ranks->comm, &draw->answer));
  KZ_MPI(MPI_Send(&ask, sizeof ask, MPI_BYTE, 0, ASK_TAG, ranks->comm));
  return KZ_OK;
}

static kz_status take_answer(kz_dispatch *draw) {
  KZ_MPI(MPI_Wait(&draw->answer, MPI_STATUS_IGNORE));
  draw->batch = draw->granted;
  return KZ_OK;
}

static kz_status next_by_message(kz_dispatch *draw, int64_t *tile) {
  kz_batch *batch = &draw->batch;
  while (batch->n == 0 && batch->more) {
    if (draw->answer == MPI_REQUEST_NULL) KZ_TRY(ask(draw, IDLE));
    KZ_TRY(take_answer(draw));
  }
  if (batch->n == 0) return KZ_OK;
  *tile = batch->first++;
  if (--batch->n == 0 && batch->more && draw->n_done > 0) return ask(draw, WORKING);
  return KZ_OK;
}

/* Rank 0 takes its tiles one by one: they cost no message. */
static int64_t take_here(kz_dispatch *draw) {
  kz_schedule_note(&draw->schedule, 0, seconds_a_tile(draw));
  if (draw->halted) return -1;
  if (draw->batch.n == 0) return kz_schedule_take(&draw->schedule, 0);
  draw->batch.n = 0;
  return draw->batch.first;
}

static void next_here(kz_dispatch *draw, int64_t *tile) {
  pthread_mutex_lock(&draw->ranks->mutex);
  *tile = take_here(draw);
  pthread_mutex_unlock(&draw->ranks->mutex);
}

kz_status kz_dispatch_next(kz_dispatch *draw, int64_t *tile) {
  kz_status status = KZ_OK;
  if (draw->handed > 0) {
    draw->busy += kz_clock() - draw->handed;
    ++draw->n_done;
  }
  *tile = -1;
  if (draw->ranks->rank == 0)
    next_here(draw, tile);
  else
    status = next_by_message(draw, tile);
  draw->handed = *tile < 0 ? 0 : kz_clock();
  return status;
}

kz_status kz_dispatch_halt(kz_dispatch *draw) {
  if (draw->ranks->rank == 0) {
    pthread_mutex_lock(&draw->ranks->mutex);
    draw->halted = true;
    pthread_mutex_unlock(&draw->ranks->mutex);
    return KZ_OK;
  }
  if (draw->answer != MPI_REQUEST_NULL) KZ_TRY(take_answer(draw));
  return draw->batch.more ? ask(draw, FAILED) : KZ_OK;
}

kz_status kz_dispatch_end(kz_dispatch *draw) {
  if (draw->threaded) pthread_join(draw->thread, NULL);
  draw->threaded = false;
  kz_schedule_end(&draw->schedule);
  KZ_MPI(draw->mpi_error);
  return KZ_OK;
}
