/* Number of tiles that a rank gets at a time, by weighted guided self-scheduling; without MPI. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  int64_t next, end; /* Tiles next .. end - 1 are left */
  int ranks, taking; /* Number of ranks; of those that still take tiles */
  double *seconds;   /* [ranks] Seconds per tile of a rank; 0 = not known yet */
  double rate;       /* Tiles per second of all ranks with known seconds */
} kz_schedule;

/* A schedule of `n_tiles` tiles for `ranks` ranks, each of which begins with the tile of its own number. */
void kz_schedule_begin(kz_schedule *schedule, int64_t n_tiles, int ranks);
void kz_schedule_end(kz_schedule *schedule);
/* Sets the seconds that a rank takes for a tile, measured by itself; 0 = not known. */
void kz_schedule_note(kz_schedule *schedule, int rank, double seconds);
/* Grants tiles *first .. *first + n - 1 to a rank; returns n. A grant is the work of this rank in half of the time that
 * all ranks need for the rest, but no longer than the limit of a batch, and at least one tile. A rank that asks early,
 * while it still works, gets none if another rank would finish it sooner. A rank that asks later gets none, and no more
 * afterwards, if the others will finish everything before it finishes one tile. Source: C. D. Polychronopoulos and D.
 * J. Kuck, IEEE Trans. Comput. C-36 (1987) 1425, with the weights of S. Flynn Hummel et al., Proc. SPAA (1996) 318. */
int64_t kz_schedule_grant(kz_schedule *schedule, int rank, bool early, int64_t *first);
/* Grants one tile, to the rank that needs no message: returns its number, or -1. */
int64_t kz_schedule_take(kz_schedule *schedule, int rank);
