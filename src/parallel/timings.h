/* Times of stages, on rank 0. */
#ifndef KAPITZA_PARALLEL_TIMINGS_H
#define KAPITZA_PARALLEL_TIMINGS_H

#include "ranks.h"

/* When something began: kz_clock, and processor seconds of this thread and of this process. */
typedef struct {
  double wall, thread, process;
} kz_stopwatch;
kz_stopwatch kz_stopwatch_start(void);

enum { KZ_WORK_LINE = 64 };
/* The work of this rank in a stage. */
typedef struct {
  const kz_ranks *ranks;
  const char *stage;
  double busy, processor;       /* s, wall and of the thread that works */
  int n;                        /* number of tiles that are not in the log yet */
  int64_t tile[KZ_WORK_LINE];   /* their numbers */
  double seconds[KZ_WORK_LINE]; /* processor seconds that each of them took */
} kz_work;

void kz_work_begin(kz_work *work, const kz_ranks *ranks, const char *stage);
/* A tile that began at `watch` is done. */
void kz_work_note(kz_work *work, int64_t tile, const kz_stopwatch *watch);
/* Writes the tiles that are not in the log yet. */
void kz_work_end(kz_work *work);

/* Adds a stage that began at `watch` to the timings and the log; `work` has ended. idle: on rank 0, the share of their time that ranks
 * had no work. Collective. */
kz_status kz_timing_note(kz_ranks *ranks, int64_t tiles, const kz_stopwatch *watch, const kz_work *work, double *idle);

#endif
