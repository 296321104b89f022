/* Progress of one stage, shown to people on rank 0. */
#ifndef KAPITZA_PARALLEL_PROGRESS_H
#define KAPITZA_PARALLEL_PROGRESS_H

#include "ranks.h"

typedef struct {
  const char *name;
  FILE *out; /* NULL: silent */
  bool live; /* a bar that is redrawn, else lines */
  bool last; /* the end of the stage is printed too */
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

#endif
