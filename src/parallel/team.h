/* The inside of a team: what the files of this floor share. */
#ifndef KAPITZA_PARALLEL_TEAM_H
#define KAPITZA_PARALLEL_TEAM_H

#include <mpi.h>

#include "checkpoint.h"
#include "kapitza/parallel.h"

struct kz_team {
  MPI_Comm comm; /* own duplicate of the world, errors are returned */
  int rank, size;
  MPI_Win counter; /* one int64 on rank 0: the next draw */
  double start;    /* s, kz_clock */
  double limit;    /* s after start; 0 = none */
  kz_progress progress;
  FILE *terminal; /* /dev/tty once opened, else NULL */
  kz_checkpoint checkpoint;
};

/* Carries a failed MPI call up with MPI's own text, file and line. */
#define KZ_MPI(call)                                                                     \
  do {                                                                                   \
    const int kz_mpi_code = (call);                                                      \
    if (kz_mpi_code != MPI_SUCCESS) return kz_mpi_fail(kz_mpi_code, __FILE__, __LINE__); \
  } while (0)
kz_status kz_mpi_fail(int code, const char *file, int line);

/* Seconds of a clock that never goes back. */
double kz_clock(void);

/* Signals that ask for a stop are noted from here on. Call before MPI_Init and again after it. */
void kz_signals_catch(void);
/* The name of the signal that asked for a stop, NULL if none came. */
const char *kz_signals_caught(void);

/* The shared counter. Create, free and reset are for all ranks at quiet times: no rank may be drawing. */
kz_status kz_counter_create(kz_team *team);
kz_status kz_counter_free(kz_team *team);
/* Rank 0 sets the counter back to 0; the others do nothing. They may draw after the next collective call. */
kz_status kz_counter_reset(kz_team *team);
/* The next number, from 0; a very large one once any rank has halted the stage. */
kz_status kz_counter_draw(kz_team *team, int64_t *drawn);
/* Every later draw of any rank is larger than any tile. Once per rank and stage. */
kz_status kz_counter_halt(kz_team *team);
/* More tiles than this cannot be counted. */
#define KZ_COUNTER_MAX ((int64_t)1 << 44)

/* KZ_STOPPED with its message where a signal or the time limit asks for a stop, else KZ_OK. */
kz_status kz_team_interrupted(const kz_team *team);
/* The same, once all ranks have left their work: the message tells whether and where that work was saved. */
kz_status kz_team_stopped(const kz_team *team);

#endif
