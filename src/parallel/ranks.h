/* The fields of kz_ranks, and functions that the files of this layer share. */
#pragma once

#include <mpi.h>
#include <pthread.h>

#include "kapitza/parallel.h"

struct kz_ranks {
  MPI_Comm comm; /* own duplicate of the world, errors are returned; MPI_COMM_NULL: MPI is not started, size is 1 */
  int rank, size;
  int thread_level;      /* of MPI, MPI_THREAD_SINGLE ... */
  pthread_mutex_t mutex; /* rank 0: who holds it may use MPI while two threads run */
  double start;          /* s, kz_clock */
  double limit;          /* s after start; 0 = none */
  kz_progress progress;
  kz_stage_describe describe; /* words for the names of stages; NULL: the names */
  FILE *log;                  /* JSON lines, rank 0; NULL: none */
  kz_timing *timings;         /* [n_timings] of the stages, rank 0 */
  int64_t n_timings, timings_capacity;
  double staged;  /* processor seconds of this process within stages */
  FILE *terminal; /* /dev/tty once opened, else NULL */
};

/* Carries a failed MPI call up with MPI's own text, file and line. */
#define KZ_MPI(call)                                                                     \
  do {                                                                                   \
    const int kz_mpi_code = (call);                                                      \
    if (kz_mpi_code != MPI_SUCCESS) return kz_mpi_fail(kz_mpi_code, __FILE__, __LINE__); \
  } while (0)
kz_status kz_mpi_fail(int code, const char *file, int line);

/* Whether there is another rank to talk to. If not, no function of MPI may be called: it may not have been started. */
static inline bool kz_ranks_several(const kz_ranks *ranks) {
  return ranks && ranks->size > 1;
}

/* From here on signals that ask for a stop are recorded. Call it before MPI_Init and again after it. */
void kz_signals_catch(void);
/* Which signal asked for a stop, "stopped by SIGTERM"; NULL if none did. Safe in a signal handler. */
const char *kz_signals_caught(void);
