/* Measures how long ranks are idle: tiles of very different length that sleep, so that ranks may outnumber cores.
 *
 *   mpirun -n RANKS uneven TILES SECONDS SLOWER      the last rank takes SLOWER times as long; SECONDS is the shortest tile
 *
 * A fifth of the tiles, side by side, takes five times as long, one in fifty another twenty times. The stage's own line tells the
 * share in which ranks were idle. tests/tools/share_model.py predicts it for any number of ranks. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "kapitza/parallel.h"

typedef struct {
  int64_t n_tiles;
  double seconds;
} load;

static kz_status rest(void *context, int64_t tile, void *record) {
  const load *l = context;
  const double draw = fmod(0.6180339887498949 * (double)tile, 1), place = (double)tile / (double)l->n_tiles;
  const double seconds = l->seconds * (place >= 0.4 && place < 0.6 ? 5 : 1) * (draw < 0.02 ? 20 : 1);
  struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * fmod(seconds, 1))};
  nanosleep(&time, NULL);
  *(char *)record = 1;
  return KZ_OK;
}

int main(int n, char **words) {
  kz_ranks *ranks = NULL;
  kz_status status = n == 4 ? kz_ranks_start(&n, &words, &ranks) : KZ_REFUSED;
  if (status == KZ_OK) {
    load l = {.n_tiles = atoll(words[1]), .seconds = atof(words[2])};
    const kz_stage stage = {.name = "uneven", .n_tiles = l.n_tiles, .record_bytes = 1, .work = rest, .context = &l};
    void *records = malloc((size_t)l.n_tiles);
    if (kz_ranks_count(ranks) > 1 && kz_ranks_own(ranks) == kz_ranks_count(ranks) - 1) l.seconds *= atof(words[3]);
    kz_ranks_set_progress(ranks, KZ_PROGRESS_ALWAYS);
    status = kz_stage_run(&(kz_run){.ranks = ranks}, &stage, records);
    free(records);
  }
  if (status != KZ_OK) fprintf(stderr, "uneven: %s\n", kz_message());
  kz_ranks_end(ranks);
  return (int)status;
}
