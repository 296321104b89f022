/* Cells of a frame, followed by a thread per core. The frame's own thread works too, and pauses between tiles. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "kapitza/common_threads.h"

#include <sched.h>
#include <stdatomic.h>

#include "kapitza/common_border.h"
#include "live.h"

enum { MOST_HELPERS = 15, STACK_BYTES = 8 << 20 };
static const double LOOK = 0.01; /* s between two pauses while helpers finish their last tiles */

/* State shared by the threads. */
typedef struct {
  const kz_frame_task *task;
  kz_border *border;     /* border of the library's call that they work for, or NULL */
  _Atomic int64_t next;  /* first tile that no thread has taken */
  pthread_mutex_t mutex; /* lock of the members below */
  pthread_cond_t ended;
  int at_work; /* helpers that have not ended */
  kz_status status;
  char message[KZ_MESSAGE_BYTES]; /* message of the thread that has failed */
} sharing;

/* A further thread: a copy of the prepared pendulum with its own unsettled states, sharing map and regions. */
typedef struct {
  sharing *all;
  kz_prepared prepared;
  pthread_t thread;
} helper;

/* Number of further cores that this process may use. */
static int spare_cores(void) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 0;
  const int cores = CPU_COUNT(&allowed);
  return cores > MOST_HELPERS ? MOST_HELPERS : cores - 1;
}

/* Follows tiles until all are taken. */
static kz_status follow_tiles(sharing *all, kz_prepared *prepared, bool pauses) {
  const kz_frame_task *task = all->task;
  KZ_AUTOFREE kz_travellers *late = kz_calloc(1, sizeof *late);
  kz_status status = KZ_OK;
  for (int64_t done; status == KZ_OK && (done = KZ_FRAME_TILE * all->next++) < task->n;) {
    if (pauses) KZ_TRY(task->frame->pause(task->frame->context));
    const int64_t part = task->n - done < KZ_FRAME_TILE ? task->n - done : KZ_FRAME_TILE;
    pthread_rwlock_rdlock(task->changing);
    status = kz_cells_follow(prepared, task->starts, part, task->number + done, late, task->cells);
    pthread_rwlock_unlock(task->changing);
  }
  pthread_rwlock_rdlock(task->changing);
  kz_cells_finish(prepared, late, task->cells);
  pthread_rwlock_unlock(task->changing);
  return status;
}

/* No thread takes a further tile. */
static void threads_stop(sharing *all) {
  all->next = all->task->n;
}

static kz_status follow_as_helper(void *context) {
  helper *h = context;
  return follow_tiles(h->all, &h->prepared, false);
}

static kz_status follow_as_first(void *context) {
  sharing *all = context;
  return follow_tiles(all, all->task->prepared, true);
}

static void *threads_help(void *context) {
  helper *h = context;
  kz_border_enter(h->all->border);
  const kz_status status = kz_border_guard(follow_as_helper, h);
  pthread_mutex_lock(&h->all->mutex);
  if (status != KZ_OK) {
    h->all->status = status;
    snprintf(h->all->message, sizeof h->all->message, "%s", kz_message());
    threads_stop(h->all);
  }
  h->all->at_work--;
  pthread_cond_signal(&h->all->ended);
  pthread_mutex_unlock(&h->all->mutex);
  return NULL;
}

/* Waits until all helpers have ended; a frame that is no longer wanted waits for the tiles that they have begun. */
static kz_status wait_for_helpers(sharing *all, kz_status status) {
  if (status != KZ_OK) threads_stop(all);
  pthread_mutex_lock(&all->mutex);
  while (all->at_work > 0) {
    kz_thread_wait(&all->ended, &all->mutex, LOOK);
    if (all->at_work == 0 || status != KZ_OK) continue;
    pthread_mutex_unlock(&all->mutex);
    status = all->task->frame->pause(all->task->frame->context);
    if (status != KZ_OK) threads_stop(all);
    pthread_mutex_lock(&all->mutex);
  }
  pthread_mutex_unlock(&all->mutex);
  if (status != KZ_OK || all->status == KZ_OK) return status;
  return kz_fail(all->status, "%s", all->message);
}

/* Ends a helper, and takes over what it has listed. */
static void threads_join(helper *h, kz_prepared *prepared) {
  pthread_join(h->thread, NULL);
  prepared->ended += h->prepared.ended;
  prepared->left += h->prepared.left;
  for (int i = 0; i < h->prepared.n_unsettled && prepared->n_unsettled < KZ_MOST_UNSETTLED; i++)
    memcpy(prepared->unsettled + 2 * prepared->n_unsettled++, h->prepared.unsettled + 2 * i,
           2 * sizeof *prepared->unsettled);
}

kz_status kz_frame_follow(const kz_frame_task *task) {
  const int64_t tiles = (task->n + KZ_FRAME_TILE - 1) / KZ_FRAME_TILE;
  const int spare = spare_cores();
  sharing all = {.task = task, .border = kz_border_here(), .mutex = PTHREAD_MUTEX_INITIALIZER};
  kz_condition_make(&all.ended);
  KZ_AUTOFREE helper *helpers = kz_calloc((size_t)spare + 1, sizeof *helpers);
  int started = 0;
  for (; started < spare && 2 * (started + 2) <= tiles; started++) { /* a thread pays from two tiles on */
    helper *h = helpers + started;
    *h = (helper){.all = &all, .prepared = *task->prepared};
    h->prepared.ended = h->prepared.left = h->prepared.n_unsettled = 0;
    pthread_mutex_lock(&all.mutex);
    all.at_work++;
    pthread_mutex_unlock(&all.mutex);
    if (kz_thread_start(&h->thread, STACK_BYTES, threads_help, h)) continue;
    pthread_mutex_lock(&all.mutex);
    all.at_work--; /* fewer threads, then */
    pthread_mutex_unlock(&all.mutex);
    break;
  }
  const kz_status status = wait_for_helpers(&all, kz_border_guard(follow_as_first, &all));
  for (int i = 0; i < started; i++) threads_join(helpers + i, task->prepared);
  kz_border_leave();
  return status;
}
