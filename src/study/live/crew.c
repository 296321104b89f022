/* Helpers are children that live for one level of a frame: they have all that is known of the pendulum by birth, and write cells into
 * memory that all share. What a helper leaves undone, because it failed or was killed, this process does. */
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
#include <unistd.h>

enum { MOST_HELPERS = 15, LEAST_TILES = 4 /* for each helper: a birth takes a millisecond */ };

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

static kz_status follow_tiles(kz_crew *crew, kz_resident *resident, const kz_frame *frame, const kz_window_starts *starts,
                              int64_t n, const int64_t *number) {
  for (int64_t done; (done = KZ_FRAME_TILE * crew->next++) < n;) {
    if (frame) KZ_TRY(frame->pause(frame->context));
    const int64_t part = n - done < KZ_FRAME_TILE ? n - done : KZ_FRAME_TILE;
    KZ_TRY(kz_cells_follow(resident, starts, part, number + done, crew->cell));
  }
  return KZ_OK;
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

/* What a helper that has ended has found on its way. */
static void take_findings(kz_resident *resident, findings *found) {
  for (int i = 0; i < found->n_strays && resident->n_strays < KZ_STRAYS; i++)
    memcpy(resident->stray + 2 * resident->n_strays++, found->stray + 2 * i, 2 * sizeof *found->stray);
  found->n_strays = 0;
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
  kz_status status = follow_tiles(crew, resident, frame, starts, n, number);
  for (int i = 0; i < born; i++) {
    if (status != KZ_OK) kill(helper[i], SIGKILL);
    waitpid(helper[i], NULL, 0);
    take_findings(resident, crew->found + i);
  }
  for (int64_t i = 0; born > 0 && status == KZ_OK && i < n; i++) /* what was left undone */
    if (crew->cell[number[i]].state == KZ_CELL_PENDING) status = kz_cells_follow(resident, starts, 1, number + i, crew->cell);
  return status;
}
