/* A small program with a checkpoint, to be killed: worker OUT [--resume]
 * Two kept stages, the second built on the first; their records go to OUT. Each tile begun adds a byte to OUT.log, so
 * that its length tells how much was done twice. Ends with the status that kapitza itself would have. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "kapitza/parallel.h"

enum { N_TILES = 60, N_NUMBERS = 700 };
static const struct timespec TILE_TIME = {.tv_nsec = 15000000};

typedef uint64_t record[N_NUMBERS];
static record table[N_TILES], cells[N_TILES];

typedef struct {
  uint64_t seed;
  const record *below; /* records of the stage before, NULL: none */
  int log;
} job;

static kz_status worker_fill(void *context, int64_t tile, void *bytes) {
  const job *j = context;
  uint64_t *number = bytes, value = j->seed + (uint64_t)tile;
  if (write(j->log, ".", 1) != 1) return kz_fail(KZ_FAILED, "the log cannot be written");
  nanosleep(&TILE_TIME, NULL);
  for (int i = 0; i < N_NUMBERS; ++i) {
    value = value * 6364136223846793005u + 1442695040888963407u;
    number[i] = value ^ (j->below ? j->below[(tile + i) % N_TILES][i] : 0);
  }
  return KZ_OK;
}

static kz_status run_stages(const kz_run *run, int log) {
  job j = {.seed = 1, .log = log};
  kz_stage stage = {.name = "table",
                    .n_tiles = N_TILES,
                    .record_bytes = sizeof(record),
                    .work = worker_fill,
                    .context = &j,
                    .keep = true};
  stage.everywhere = true;
  KZ_TRY(kz_stage_run(run, &stage, table));
  j = (job){.seed = 2, .below = (const record *)table, .log = log};
  stage.name = "cells";
  stage.everywhere = false;
  return kz_stage_run(run, &stage, cells);
}

static kz_status worker_save(const char *path) {
  char part[4096];
  snprintf(part, sizeof part, "%s.part", path);
  FILE *file = fopen(part, "wb");
  if (!file) return kz_fail(KZ_FAILED, "%s: cannot be created", part);
  const size_t written = fwrite(table, sizeof table, 1, file) + fwrite(cells, sizeof cells, 1, file);
  if (fclose(file) == 0 && written == 2 && rename(part, path) == 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: cannot be written", path);
}

/* Ranks of the earlier run may have finished the result while this one waited: ask after opening. */
static kz_status worker_work(const kz_run *run, const char *path, bool resume, int log) {
  bool done = resume && access(path, F_OK) == 0;
  KZ_TRY(kz_ranks_broadcast(run->ranks, &done, sizeof done));
  if (done) return KZ_OK;
  KZ_TRY(run_stages(run, log));
  return kz_ranks_agree(run->ranks, kz_rank(run->ranks) == 0 ? worker_save(path) : KZ_OK);
}

static kz_status run_worker(kz_ranks *ranks, const char *path, bool resume) {
  char name[4096];
  snprintf(name, sizeof name, "%s.log", path);
  const int log = open(name, O_WRONLY | O_CREAT | O_APPEND, 0666);
  KZ_TRY(kz_ranks_agree(ranks, log < 0 ? kz_fail(KZ_REFUSED, "%s: cannot be created", name) : KZ_OK));
  snprintf(name, sizeof name, "%s.checkpoint", path);
  const kz_checkpoint_plan plan = {.path = name, .fingerprint = "program: worker\n", .resume = resume};
  kz_run run = {.ranks = ranks};
  KZ_TRY(kz_checkpoint_open(ranks, &plan, &run.checkpoint));
  kz_status status = worker_work(&run, path, resume, log);
  if (status == KZ_STOPPED) status = kz_checkpoint_stopped(run.checkpoint);
  const kz_status closed = kz_checkpoint_close(ranks, run.checkpoint, status == KZ_OK);
  return status == KZ_OK ? closed : status;
}

int main(int n, char **words) {
  if (n < 2) return KZ_REFUSED;
  kz_ranks *ranks = NULL;
  kz_status status = kz_ranks_start(&n, &words, &ranks);
  if (status == KZ_OK) status = run_worker(ranks, words[1], n > 2 && strcmp(words[2], "--resume") == 0);
  if (status != KZ_OK && kz_launch_rank() <= 0) fprintf(stderr, "worker: %s\n", kz_message());
  kz_ranks_end(ranks);
  return (int)status;
}
