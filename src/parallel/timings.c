/* Where the time went, stage by stage: for people at the end, for programs as JSON lines. */
#include "timings.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

double kz_processor_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The row of a stage's name, a new one where it comes for the first time; NULL where memory ran out. */
static kz_timing *row_of(kz_ranks *ranks, const char *name) {
  for (int64_t i = 0; i < ranks->n_timings; ++i)
    if (strncmp(ranks->timings[i].stage, name, sizeof ranks->timings[i].stage - 1) == 0) return &ranks->timings[i];
  kz_timing *list = realloc(ranks->timings, (size_t)(ranks->n_timings + 1) * sizeof *list);
  if (!list) return NULL;
  ranks->timings = list;
  kz_timing *row = &list[ranks->n_timings++];
  *row = (kz_timing){0};
  memcpy(row->stage, name, strnlen(name, sizeof row->stage - 1));
  return row;
}

static void log_stage(const kz_ranks *ranks, const char *name, const kz_timing *t) {
  if (!ranks->log) return;
  fprintf(ranks->log,
          "{\"event\": \"stage\", \"seconds\": %.3f, \"stage\": \"%s\", \"tiles\": %lld, \"wall\": %.6f, \"processor\": %.6f, "
          "\"busy\": %.4f}\n",
          kz_clock() - ranks->start, name, (long long)t->tiles, t->wall, t->processor,
          t->wall > 0 ? t->busy / (t->wall * ranks->size) : 1);
  fflush(ranks->log);
}

kz_status kz_timing_note(kz_ranks *ranks, const char *name, int64_t tiles, const kz_stopwatch *watch, double busy,
                         double *idle) {
  const double own[] = {busy, kz_processor_seconds() - watch->processor};
  double sum[] = {0, 0};
  const double wall = kz_clock() - watch->wall;
  KZ_MPI(MPI_Reduce(own, sum, 2, MPI_DOUBLE, MPI_SUM, 0, ranks->comm));
  if (ranks->rank != 0) return KZ_OK;
  const double share = wall > 0 ? sum[0] / (wall * ranks->size) : 1;
  *idle = share < 1 ? 1 - share : 0;
  const kz_timing t = {.tiles = tiles, .wall = wall, .processor = sum[1], .busy = sum[0]};
  kz_timing *row = row_of(ranks, name);
  if (!row) return kz_fail(KZ_FAILED, "out of memory for timings");
  ++row->calls;
  row->tiles += tiles;
  row->wall += wall;
  row->processor += sum[1];
  row->busy += sum[0];
  if (tiles == 1) row->serial += wall;
  log_stage(ranks, name, &t);
  return KZ_OK;
}

kz_stopwatch kz_stopwatch_start(void) {
  return (kz_stopwatch){kz_clock(), kz_processor_seconds()};
}

int64_t kz_ranks_timings(const kz_ranks *ranks, const kz_timing **list) {
  *list = ranks->timings;
  return ranks->n_timings;
}

double kz_ranks_seconds(const kz_ranks *ranks) {
  return kz_clock() - ranks->start;
}

void kz_ranks_set_log(kz_ranks *ranks, FILE *log) {
  ranks->log = log;
}
