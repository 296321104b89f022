/* Helpers are children that live for one level of a frame: they have all that is known of the pendulum by birth, and write cells into
 * memory that all share. What a helper leaves undone, because it failed, hangs or was killed, this process does. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "live.h"

#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_HELPERS = 15, LEAST_TILES = 2 /* for each helper: a birth takes a millisecond */ };
/* A helper has at most one tile left when this process has none. It hangs if that takes so many seconds, and so many times as long as all
 * tiles of this process took. */
enum { LEAST_PATIENCE = 2, MORE_PATIENCE = 10 };
enum { LONGEST_PAUSE = 500000 }; /* ns between two looks */

typedef struct {
  int n_strays;
  double stray[2 * KZ_STRAYS];
} findings;

struct kz_crew {
  int helpers;
  size_t bytes;
  _Atomic int64_t next; /* tile that nobody has taken */
  findings found[MOST_HELPERS];
  kz_frame_cell cell[];
};

/* Number of further cores that this process may use. */
static int spare_cores(void) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 0;
  const int cores = CPU_COUNT(&allowed);
  return cores > MOST_HELPERS ? MOST_HELPERS : cores - 1;
}

kz_crew *kz_crew_create(int64_t total) {
  const size_t bytes = sizeof(kz_crew) + (size_t)total * sizeof(kz_frame_cell);
  int helpers = spare_cores();
  kz_crew *crew = MAP_FAILED;
  if (helpers > 0) crew = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (crew == MAP_FAILED) {
    helpers = 0;
    crew = kz_calloc(1, bytes);
  }
  crew->helpers = helpers;
  crew->bytes = bytes;
  return crew;
}

void kz_crew_free(kz_crew *crew) {
  if (crew && crew->helpers > 0)
    munmap(crew, crew->bytes);
  else
    free(crew);
}

kz_frame_cell *kz_crew_cells(kz_crew *crew) {
  return crew->cell;
}

/* Follows tiles until all are taken; a helper does not `pause`. */
static kz_status follow_tiles(kz_crew *crew, const kz_crew_task *task, bool pauses) {
  KZ_FREED kz_travellers *late = kz_calloc(1, sizeof *late);
  for (int64_t done; (done = KZ_FRAME_TILE * crew->next++) < task->n;) {
    if (pauses) KZ_TRY(task->frame->pause(task->frame->context));
    const int64_t part = task->n - done < KZ_FRAME_TILE ? task->n - done : KZ_FRAME_TILE;
    KZ_TRY(kz_cells_follow(task->resident, task->starts, part, task->number + done, late, crew->cell));
  }
  kz_cells_finish(task->resident, late, crew->cell);
  return KZ_OK;
}

/* A helper's life: it says nothing, and ends with its parent. */
static void help(kz_crew *crew, pid_t parent, findings *found, const kz_crew_task *task) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  task->resident->n_strays = 0;
  follow_tiles(crew, task, false);
  memcpy(found->stray, task->resident->stray, sizeof found->stray);
  found->n_strays = task->resident->n_strays;
  _exit(0);
}

/* Waits until a helper has ended. One that hangs is killed at the time `last`, and so is one whose frame is no longer wanted. */
static kz_status wait_for(pid_t helper, const kz_frame *frame, double last) {
  kz_status status = KZ_OK;
  for (int64_t pause = 20000; waitpid(helper, NULL, WNOHANG) == 0; pause = pause < LONGEST_PAUSE ? 2 * pause : pause) {
    status = frame->pause(frame->context);
    if (status != KZ_OK || kz_clock() > last) {
      kill(helper, SIGKILL);
      waitpid(helper, NULL, 0);
      break;
    }
    nanosleep(&(struct timespec){.tv_nsec = pause}, NULL);
  }
  return status;
}

/* What a helper that has ended has found on its way. */
static void take_findings(kz_resident *resident, findings *found) {
  for (int i = 0; i < found->n_strays && resident->n_strays < KZ_STRAYS; i++)
    memcpy(resident->stray + 2 * resident->n_strays++, found->stray + 2 * i, 2 * sizeof *found->stray);
  found->n_strays = 0;
}

/* Follows those of n cells that helpers have left undone. */
static kz_status follow_rest(kz_crew *crew, kz_crew_task task) {
  KZ_FREED int64_t *pending = kz_malloc((size_t)task.n * sizeof *pending);
  int64_t left = 0;
  for (int64_t i = 0; i < task.n; i++)
    if (crew->cell[task.number[i]].end.evidence == 0) pending[left++] = task.number[i];
  crew->next = 0;
  task.n = left;
  task.number = pending;
  return follow_tiles(crew, &task, true);
}

kz_status kz_crew_follow(kz_crew *crew, const kz_crew_task *task) {
  const int64_t tiles = (task->n + KZ_FRAME_TILE - 1) / KZ_FRAME_TILE, worth = tiles / LEAST_TILES - 1;
  const pid_t self = getpid();
  pid_t helper[MOST_HELPERS];
  int born = 0;
  crew->next = 0;
  while (born < crew->helpers && born < worth) {
    helper[born] = fork();
    if (helper[born] == 0) help(crew, self, crew->found + born, task);
    if (helper[born] < 0) break; /* fewer helpers, then */
    born++;
  }
  const double begin = kz_clock();
  kz_status status = follow_tiles(crew, task, true);
  const double end = kz_clock(), last = end + LEAST_PATIENCE + MORE_PATIENCE * (end - begin);
  for (int i = 0; i < born; i++) {
    if (status != KZ_OK) kill(helper[i], SIGKILL);
    const kz_status heard = wait_for(helper[i], task->frame, last);
    if (status == KZ_OK) status = heard;
    take_findings(task->resident, crew->found + i);
  }
  return born > 0 && status == KZ_OK ? follow_rest(crew, *task) : status;
}
