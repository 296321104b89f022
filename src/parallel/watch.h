/* Reports of rank 0 on a stage: progress for people, and times. */
#pragma once

#include "ranks.h"

typedef struct {
  const char *name;
  char words[64]; /* Description of the stage */
  FILE *out;      /* NULL: silent */
  bool live;      /* True: a bar that is redrawn, else lines */
  bool last;      /* True: the end of the stage is printed too */
  bool shown;
  int64_t total, first; /* Number of tiles; of tiles done before */
  double begun, due;    /* Begin, and time of the next display, s, kz_clock */
  double log_due;       /* Next line of the log, s, kz_clock */
  const kz_ranks *ranks;
} kz_meter;

/* Begins a stage of `total` tiles of which `first` are done. */
void kz_meter_begin(kz_meter *meter, kz_ranks *ranks, const char *name, int64_t total, int64_t first);
/* Shows `done` tiles if it is time for it. */
void kz_meter_show(kz_meter *meter, int64_t done);
/* Removes the bar, or prints the end with `idle`, the share of their time in which ranks were idle. */
void kz_meter_end(kz_meter *meter, bool complete, double idle);

/* Start of a measurement: kz_clock, processor seconds of this thread and of this process. */
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

/* Notes that a tile that began at `watch` is done. */
void kz_work_note(kz_work *work, int64_t tile, const kz_stopwatch *watch);
/* Writes the tiles that are not in the log yet. */
void kz_work_end(kz_work *work);

/* Adds a stage that began at `watch` to the timings and the log; `work` has ended. idle: on rank 0, the share of their
 * time that ranks had no work. Collective. */
kz_status kz_timing_note(kz_ranks *ranks, int64_t tiles, const kz_stopwatch *watch, const kz_work *work, double *idle);
