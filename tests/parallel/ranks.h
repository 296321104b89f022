/* Common part of tests on several ranks: an assertion that fails on one rank fails on all; none waits. */
#pragma once

#define OWN_MAIN
#include "../tools/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "kapitza/parallel.h"

static kz_ranks *ranks;
static kz_checkpoint *checkpoint; /* NULL: none is open */

static inline kz_status run_stage(const kz_stage *stage, void *records) {
  return kz_stage_run(&(kz_run){.ranks = ranks, .checkpoint = checkpoint}, stage, records);
}

static inline kz_status open_checkpoint(const kz_checkpoint_plan *plan) {
  return kz_checkpoint_open(ranks, plan, &checkpoint);
}

static inline kz_status close_checkpoint(bool complete) {
  kz_checkpoint *closed = checkpoint;
  checkpoint = NULL;
  return kz_checkpoint_close(ranks, closed, complete);
}

#define assert_all(condition) assert_on_all((condition), #condition, __LINE__)

static inline void assert_on_all(int holds, const char *text, int line) {
  if (!holds) print_error("rank %d: %s is false (line %d); message: %s\n", kz_rank(ranks), text, line, kz_message());
  kz_message_clear();
  const kz_status agreed = kz_ranks_agree(ranks, holds ? KZ_OK : KZ_FAILED);
  kz_message_clear();
  if (agreed != KZ_OK) _fail(__FILE__, line);
}

static inline void pause_for(double seconds) {
  const struct timespec time = {.tv_sec = (time_t)seconds,
                                .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
  nanosleep(&time, NULL);
}

static inline int run_ranks(void) {
  if (kz_ranks_start(NULL, NULL, &ranks) != KZ_OK) return 1;
  kz_ranks_set_progress(ranks, KZ_PROGRESS_NEVER);
  const int failed = run_all_tests(NULL, NULL);
  kz_ranks_end(ranks);
  return failed;
}

/* Runs with `path` [bytes] in a folder of its own, for a checkpoint. */
static inline int run_ranks_with_path(char *path, size_t bytes) {
  char folder[] = "/tmp/kapitza-ranks-XXXXXX";
  if (kz_launch_rank() <= 0 && !mkdtemp(folder)) return 1;
  if (kz_ranks_start(NULL, NULL, &ranks) != KZ_OK) return 1;
  kz_ranks_set_progress(ranks, KZ_PROGRESS_NEVER);
  kz_ranks_broadcast(ranks, folder, sizeof folder);
  snprintf(path, bytes, "%s/a.checkpoint", folder);
  const int failed = run_all_tests(NULL, NULL);
  if (kz_rank(ranks) == 0) {
    unlink(path);
    rmdir(folder);
  }
  kz_ranks_end(ranks);
  return failed;
}
