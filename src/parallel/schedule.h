/* How many tiles a rank gets at a time: weighted guided self-scheduling. Knows no MPI. */
#ifndef KAPITZA_PARALLEL_SCHEDULE_H
#define KAPITZA_PARALLEL_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  int64_t next, end; /* tiles next .. end - 1 have not been given away */
  int ranks, taking; /* ranks; of these, those that still take tiles */
  double *seconds;   /* [ranks] that a rank takes for a tile, 0 = not known yet */
  double rate;       /* tiles a second of all ranks that are known */
} kz_schedule;

/* A schedule of `n_tiles` tiles for `ranks` ranks, each of which begins with the tile of its own number; false without memory. */
void kz_schedule_begin(kz_schedule *schedule, int64_t n_tiles, int ranks);
void kz_schedule_end(kz_schedule *schedule);
/* A rank takes `seconds` for a tile, by what it has done so far; 0 = it does not know. */
void kz_schedule_note(kz_schedule *schedule, int rank, double seconds);
/* Gives tiles *first .. *first + n - 1 to a rank; returns n. It is what the rank does in half of the time that all ranks need for the
 * rest, but no more than a batch should last, and at least one tile. A rank that asks early, while it still works, gets none where
 * others would have done it sooner; one that asks later gets none, now and for good, where the others will have done all before it
 * has done one. Source: C. D. Polychronopoulos and D. J. Kuck, IEEE Trans. Comput. C-36 (1987) 1425, with the
 * weights of S. Flynn Hummel et al., Proc. SPAA (1996) 318. */
int64_t kz_schedule_grant(kz_schedule *schedule, int rank, bool early, int64_t *first);
/* The same of one tile, for a rank that costs no message: its number, or -1. */
int64_t kz_schedule_take(kz_schedule *schedule, int rank);

#endif
