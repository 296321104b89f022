/* What rank 0 reports of a stage: its progress, shown to people, and its times. */
#pragma once

#include "ranks.h"

typedef struct {
  const char *name;
  char words[64]; /* what progress calls it */
  FILE *out;      /* NULL: silent */
  bool live;      /* a bar that is redrawn, else lines */
  bool last;      /* the end of the stage is printed too */
  bool shown;
  int64_t total, first; /* tiles; `first` were done before */
  double begun, due;    /* s, kz_clock; nothing is shown before `due` */
  double log_due;       /* the same of the log */
  const kz_ranks *ranks;
} kz_meter;

/* Begins a stage of `total` tiles of which `first` are done. */
void kz_meter_begin(kz_meter *meter, kz_ranks *ranks, const char *name, int64_t total, int64_t first);
/* Shows `done` tiles if it is time for it. */
void kz_meter_show(kz_meter *meter, int64_t done);
/* Removes the bar, or prints the end with `idle`, the share of their time in which ranks were idle. */
void kz_meter_end(kz_meter *meter, bool complete, double idle);

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

/* A tile that began at `watch` is done. */
void kz_work_note(kz_work *work, int64_t tile, const kz_stopwatch *watch);
/* Writes the tiles that are not in the log yet. */
void kz_work_end(kz_work *work);

/* Adds a stage that began at `watch` to the timings and the log; `work` has ended. idle: on rank 0, the share of their time that ranks
 * had no work. Collective. */
kz_status kz_timing_note(kz_ranks *ranks, int64_t tiles, const kz_stopwatch *watch, const kz_work *work, double *idle);
