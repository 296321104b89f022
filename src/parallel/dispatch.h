/* Distribution of tiles by plain messages. Rank 0 grants some tiles at a time, from a thread of its own, so that it
 * answers while it works on its own tiles.
 *
 *   rank -> 0   ask: seconds it takes for a tile; whether it still works, is idle, or cannot go on
 *   0 -> rank   tiles first .. first + n - 1; whether asking again makes sense
 *
 * A rank begins with the tile of its own number, unasked, and asks for the next tiles before the last tile of the
 * present one. */
#pragma once

#include <pthread.h>

#include "ranks.h"
#include "schedule.h"

typedef struct {
  int64_t first, n; /* tiles */
  int64_t more;     /* 0: there are no others */
} kz_grant;

typedef struct {
  kz_ranks *ranks;
  int64_t n_done;
  double busy;        /* Time spent on tiles, s */
  double handed;      /* kz_clock when the present tile was handed out, s; 0 = none */
  kz_grant grant;     /* Tiles in hand */
  kz_grant next;      /* Answer to the pending request */
  MPI_Request answer; /* Pending receive; MPI_REQUEST_NULL: none */
  /* Fields of rank 0, under ranks->mutex while the thread runs */
  kz_schedule schedule;
  int will_ask; /* Number of ranks that will ask once more */
  bool halted;  /* True: no rank gets a further tile */
  bool threaded;
  pthread_t thread;
  int mpi_error; /* MPI error of the thread */
} kz_dispatch;

/* Distributes `n_tiles` tiles. Until kz_dispatch_end, which every rank must call, the ranks may use MPI through
 * kz_dispatch only. */
void kz_dispatch_begin(kz_dispatch *dispatch, kz_ranks *ranks, int64_t n_tiles);
/* *tile = the next tile of this rank; -1 if none is left, or if a rank has halted. */
kz_status kz_dispatch_next(kz_dispatch *dispatch, int64_t *tile);
/* Announces that this rank cannot go on. The other ranks get no further tiles. */
kz_status kz_dispatch_halt(kz_dispatch *dispatch);
/* Rank 0 waits until all others know that nothing is left. */
kz_status kz_dispatch_end(kz_dispatch *dispatch);
