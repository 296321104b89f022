#include "schedule.h"

#include "kapitza/common.h"

/* Time of a batch, s: much longer than a message, too short to be noticed; and per rank, so that rank 0, which answers
 * some 10^5 requests a second, gets at most a tenth of them. */
static const double BATCH_SECONDS = 0.1, SECONDS_A_RANK = 1e-4;

void kz_schedule_begin(kz_schedule *schedule, int64_t n_tiles, int ranks) {
  *schedule = (kz_schedule){.next = kz_smaller(ranks, n_tiles), .end = n_tiles, .ranks = ranks, .taking = ranks};
  schedule->seconds = kz_calloc((size_t)ranks, sizeof *schedule->seconds);
}

void kz_schedule_end(kz_schedule *schedule) {
  free(schedule->seconds);
  schedule->seconds = NULL;
}

void kz_schedule_note(kz_schedule *schedule, int rank, double seconds) {
  double *known = &schedule->seconds[rank];
  if (seconds <= 0) return;
  schedule->rate += 1 / seconds - (*known > 0 ? 1 / *known : 0);
  *known = seconds;
}

/* Tiles per second of the other ranks; 0 if not known. */
static double rate_of_others(const kz_schedule *schedule, double seconds) {
  static const double rounding = 1e-9; /* Relative rounding of the sum */
  const double rate = schedule->rate - 1 / seconds;
  return rate * seconds > rounding ? rate : 0;
}

/* Drops a rank whose time per tile exceeds the others' time for all remaining tiles and those in hand. */
static bool retire_rank(kz_schedule *schedule, int rank) {
  const double seconds = schedule->seconds[rank], others = seconds > 0 ? rate_of_others(schedule, seconds) : 0;
  if (seconds * others <= (double)(schedule->end - schedule->next + schedule->taking - 1)) return false;
  schedule->rate = others;
  schedule->seconds[rank] = 0;
  --schedule->taking;
  return true;
}

int64_t kz_schedule_take(kz_schedule *schedule, int rank) {
  return schedule->next == schedule->end || retire_rank(schedule, rank) ? -1 : schedule->next++;
}

int64_t kz_schedule_grant(kz_schedule *schedule, int rank, bool early, int64_t *first) {
  const int64_t left = schedule->end - schedule->next;
  const double seconds = schedule->seconds[rank];
  double tiles = 1;
  *first = schedule->next;
  if (left == 0 || (!early && retire_rank(schedule, rank))) return 0;
  if (seconds > 0) {
    const double rest = (double)left / fmax(schedule->rate, 1 / seconds); /* Time of all ranks together, s */
    if (early && rest < 2 * seconds) return 0;
    tiles = fmin(rest / 2, fmax(BATCH_SECONDS, SECONDS_A_RANK * schedule->ranks)) / seconds;
  }
  const int64_t n = tiles >= (double)left ? left : tiles > 1 ? (int64_t)tiles : 1;
  schedule->next += n;
  return n;
}
