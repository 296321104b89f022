/* Times of the stages: a table for people at the end, JSON lines for programs. */
#include "watch.h"

kz_stopwatch kz_stopwatch_start(void) {
  return (kz_stopwatch){kz_clock(), kz_processor_clock(), kz_process_clock()};
}

void kz_work_end(kz_work *work) {
  FILE *log = work->ranks->log;
  if (work->n == 0) return;
  fprintf(log, "{\"event\": \"tiles\", \"seconds\": %.3f, \"stage\": \"%s\", \"tile\": [",
          kz_ranks_seconds(work->ranks), work->stage);
  for (int i = 0; i < work->n; ++i) fprintf(log, "%s%lld", i ? ", " : "", (long long)work->tile[i]);
  fputs("], \"processor\": [", log);
  for (int i = 0; i < work->n; ++i) fprintf(log, "%s%.6f", i ? ", " : "", work->seconds[i]);
  fputs("]}\n", log);
  work->n = 0;
}

void kz_work_note(kz_work *work, int64_t tile, const kz_stopwatch *watch) {
  const kz_stopwatch now = kz_stopwatch_start();
  work->busy += now.wall - watch->wall;
  work->processor += now.thread - watch->thread;
  if (!work->ranks->log) return;
  work->tile[work->n] = tile;
  work->seconds[work->n] = now.thread - watch->thread;
  if (++work->n == KZ_WORK_LINE) kz_work_end(work);
}

/* Returns the row of a stage's name, a new one for a new name. */
static kz_timing *timing_of(kz_ranks *ranks, const char *name) {
  for (int64_t i = 0; i < ranks->n_timings; ++i)
    if (strncmp(ranks->timings[i].stage, name, sizeof ranks->timings[i].stage - 1) == 0) return &ranks->timings[i];
  ranks->timings =
      kz_list_reserve(ranks->timings, &ranks->timings_capacity, ranks->n_timings + 1, sizeof *ranks->timings);
  kz_timing *row = &ranks->timings[ranks->n_timings++];
  *row = (kz_timing){0};
  memcpy(row->stage, name, strnlen(name, sizeof row->stage - 1));
  return row;
}

static void log_stage(const kz_ranks *ranks, const char *name, const kz_timing *t) {
  if (!ranks->log) return;
  fprintf(ranks->log,
          "{\"event\": \"stage\", \"seconds\": %.3f, \"stage\": \"%s\", \"tiles\": %lld, \"wall\": %.6f, "
          "\"processor\": %.6f, "
          "\"most\": %.6f, \"busy\": %.4f}\n",
          kz_clock() - ranks->start, name, (long long)t->tiles, t->wall, t->processor, t->most,
          t->wall > 0 ? t->busy / (t->wall * ranks->size) : 1);
  fflush(ranks->log);
}

static void add_timing(kz_timing *row, const kz_timing *t) {
  ++row->calls;
  row->tiles += t->tiles;
  row->wall += t->wall;
  row->processor += t->processor;
  row->most += t->most;
  row->busy += t->busy;
  if (t->tiles == 1) row->serial += t->wall;
}

kz_status kz_timing_note(kz_ranks *ranks, int64_t tiles, const kz_stopwatch *watch, const kz_work *work, double *idle) {
  const double own[] = {work->busy, work->processor};
  double sum[] = {work->busy, work->processor}, most = work->processor;
  const kz_stopwatch now = kz_stopwatch_start();
  const double wall = now.wall - watch->wall;
  ranks->staged += now.process - watch->process;
  if (kz_ranks_several(ranks)) {
    KZ_MPI(MPI_Reduce(own, sum, 2, MPI_DOUBLE, MPI_SUM, 0, ranks->comm));
    KZ_MPI(MPI_Reduce(&own[1], &most, 1, MPI_DOUBLE, MPI_MAX, 0, ranks->comm));
  }
  if (ranks->rank != 0) return KZ_OK;
  const double share = wall > 0 ? sum[0] / (wall * ranks->size) : 1;
  *idle = share < 1 ? 1 - share : 0;
  const kz_timing t = {.tiles = tiles, .wall = wall, .processor = sum[1], .most = most, .busy = sum[0]};
  kz_timing *row = timing_of(ranks, work->stage);
  add_timing(row, &t);
  log_stage(ranks, work->stage, &t);
  return KZ_OK;
}

int64_t kz_ranks_timings(const kz_ranks *ranks, const kz_timing **list) {
  *list = ranks->timings;
  return ranks->n_timings;
}

double kz_ranks_seconds(const kz_ranks *ranks) {
  return kz_clock() - ranks->start;
}

double kz_ranks_outside(const kz_ranks *ranks) {
  return kz_process_clock() - ranks->staged;
}

void kz_ranks_set_log(kz_ranks *ranks, FILE *log) {
  ranks->log = log;
}
