/* Times of stages, on rank 0. */
#ifndef KAPITZA_PARALLEL_TIMINGS_H
#define KAPITZA_PARALLEL_TIMINGS_H

#include "ranks.h"

/* When a stage began: kz_clock and processor seconds of this process. */
typedef struct {
  double wall, processor;
} kz_stopwatch;
kz_stopwatch kz_stopwatch_start(void);
double kz_processor_seconds(void);

/* Adds a stage to the timings and the log; busy: seconds for which this rank had work. idle: on rank 0, the share of their time that
 * ranks had none. Collective. */
kz_status kz_timing_note(kz_ranks *ranks, const char *name, int64_t tiles, const kz_stopwatch *watch, double busy,
                         double *idle);

#endif
