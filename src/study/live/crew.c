/* Helpers are children that live for one level of a frame: they have all that is known of the pendulum by birth, and write cells into
 * memory that all share. What a helper leaves undone, because it failed, hangs or was killed, this process does. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "crew.h"

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

int kz_spare_cores(void) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 0;
  const int cores = CPU_COUNT(&allowed);
  return cores > MOST_HELPERS ? MOST_HELPERS : cores - 1;
}

kz_crew *kz_crew_create(int64_t total, int helpers) {
  const size_t bytes = sizeof(kz_crew) + (size_t)total * sizeof(kz_frame_cell);
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

static kz_status follow_next_tiles(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts,
                                   int64_t n, const int64_t *number, kz_travellers *late) {
  for (int64_t done; (done = KZ_FRAME_TILE * crew->next++) < n;) {
    if (frame) KZ_TRY(frame->pause(frame->context));
    const int64_t part = n - done < KZ_FRAME_TILE ? n - done : KZ_FRAME_TILE;
    KZ_TRY(kz_cells_follow(resident, starts, part, number + done, late, crew->cell));
  }
  kz_cells_finish(resident, late, crew->cell);
  return KZ_OK;
}

static kz_status follow_tiles(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts,
                              int64_t n, const int64_t *number) {
  kz_travellers *late = kz_calloc(1, sizeof *late);
  const kz_status status = follow_next_tiles(crew, resident, frame, starts, n, number, late);
  free(late);
  return status;
}

/* A helper's life: it says nothing, and ends with its parent. */
static void help(kz_crew *crew, pid_t parent, int helper, kz_resident *resident, const kz_window_starts *starts, int64_t n,
                 const int64_t *number) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  resident->n_strays = 0;
  follow_tiles(crew, resident, NULL, starts, n, number);
  findings *found = crew->found + helper;
  memcpy(found->stray, resident->stray, sizeof found->stray);
  found->n_strays = resident->n_strays;
  _exit(0);
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Waits until a helper has ended. One that hangs is killed at the time `last`, and so is one whose frame is no longer wanted. */
static kz_status wait_for(pid_t helper, const kz_frame *frame, double last) {
  kz_status status = KZ_OK;
  for (int64_t pause = 20000; waitpid(helper, NULL, WNOHANG) == 0; pause = pause < LONGEST_PAUSE ? 2 * pause : pause) {
    status = frame->pause(frame->context);
    if (status != KZ_OK || seconds() > last) {
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
static kz_status follow_rest(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts,
                             int64_t n, const int64_t *number) {
  int64_t *pending = kz_malloc((size_t)n * sizeof *pending), left = 0;
  for (int64_t i = 0; i < n; i++)
    if (crew->cell[number[i]].state == KZ_CELL_PENDING) pending[left++] = number[i];
  crew->next = 0;
  const kz_status status = follow_tiles(crew, resident, frame, starts, left, pending);
  free(pending);
  return status;
}

kz_status kz_crew_follow(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts, int64_t n,
                         const int64_t *number) {
  const int64_t tiles = (n + KZ_FRAME_TILE - 1) / KZ_FRAME_TILE, worth = tiles / LEAST_TILES - 1;
  const pid_t self = getpid();
  pid_t helper[MOST_HELPERS];
  int born = 0;
  crew->next = 0;
  while (born < crew->helpers && born < worth) {
    helper[born] = fork();
    if (helper[born] == 0) help(crew, self, born, resident, starts, n, number);
    if (helper[born] < 0) break; /* fewer helpers, then */
    born++;
  }
  const double begin = seconds();
  kz_status status = follow_tiles(crew, resident, frame, starts, n, number);
  const double end = seconds(), last = end + LEAST_PATIENCE + MORE_PATIENCE * (end - begin);
  for (int i = 0; i < born; i++) {
    if (status != KZ_OK) kill(helper[i], SIGKILL);
    const kz_status heard = wait_for(helper[i], frame, last);
    if (status == KZ_OK) status = heard;
    take_findings(resident, crew->found + i);
  }
  return born > 0 && status == KZ_OK ? follow_rest(crew, resident, frame, starts, n, number) : status;
}
