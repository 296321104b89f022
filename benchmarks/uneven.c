/* Measures how long ranks are idle: tiles that sleep, so that ranks may outnumber cores.
 *
 *   mpirun -n RANKS build/benchmarks/uneven FILE SLOWER      FILE: the seconds of each tile, a line each; the last rank
 * takes SLOWER times as long
 *
 * The stage's own line tells the share in which ranks were idle. benchmarks/scaling.py makes FILE from the log of a run
 * and predicts the share for any number of ranks. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "kapitza/parallel.h"

typedef struct {
  int64_t n;
  double *seconds; /* [n] */
  double slower;
} load;

static kz_status uneven_rest(void *context, int64_t tile, void *record) {
  const load *l = context;
  const double seconds = l->slower * l->seconds[tile];
  struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * fmod(seconds, 1))};
  nanosleep(&time, NULL);
  *(char *)record = 1;
  return KZ_OK;
}

static kz_status read_load(const char *path, load *l) {
  FILE *file = fopen(path, "r");
  double seconds;
  while (file && fscanf(file, "%lf", &seconds) == 1) {
    double *longer = realloc(l->seconds, (size_t)(l->n + 1) * sizeof *longer);
    if (!longer) break;
    l->seconds = longer;
    l->seconds[l->n++] = seconds;
  }
  const bool whole = file && feof(file);
  if (file) fclose(file);
  return whole ? KZ_OK : kz_fail(KZ_REFUSED, "%s: cannot be read as numbers", path);
}

static kz_status uneven_run(kz_ranks *ranks, const char *path, double slower) {
  load l = {.slower = kz_ranks_count(ranks) > 1 && kz_rank(ranks) == kz_ranks_count(ranks) - 1 ? slower : 1};
  kz_status status = read_load(path, &l);
  char *records = calloc((size_t)l.n + 1, 1);
  if (status == KZ_OK && !records) status = kz_fail(KZ_FAILED, "out of memory");
  const kz_stage stage = {.name = "uneven", .n_tiles = l.n, .record_bytes = 1, .work = rest, .context = &l};
  kz_ranks_set_progress(ranks, KZ_PROGRESS_ALWAYS);
  if (status == KZ_OK) status = kz_stage_run(&(kz_run){.ranks = ranks}, &stage, records);
  free(records);
  free(l.seconds);
  return status;
}

int main(int n, char **words) {
  kz_ranks *ranks = NULL;
  kz_status status = n == 3 ? KZ_OK : kz_fail(KZ_REFUSED, "usage: uneven FILE SLOWER");
  if (status == KZ_OK) status = kz_ranks_start(&n, &words, &ranks);
  if (status == KZ_OK) status = uneven_run(ranks, words[1], atof(words[2]));
  if (status != KZ_OK) fprintf(stderr, "uneven: %s\n", kz_message());
  kz_ranks_end(ranks);
  return (int)status;
}
