/* Fields of kz_ranks, and functions that the files of this layer share. */
#pragma once

#include <mpi.h>
#include <pthread.h>

#include "kapitza/parallel.h"

struct kz_ranks {
  MPI_Comm comm; /* Duplicate of the world that returns errors; MPI_COMM_NULL: MPI is not started, size is 1 */
  int rank, size;
  int thread_level;      /* Thread level of MPI, MPI_THREAD_SINGLE ... */
  pthread_mutex_t mutex; /* Right to use MPI while two threads of rank 0 run */
  double start;          /* s, kz_clock */
  double limit;          /* s after start; 0 = none */
  kz_progress progress;
  kz_stage_describe describe; /* Descriptions of stages; NULL: their names */
  FILE *log;                  /* JSON lines, rank 0; NULL: none */
  kz_timing *timings;         /* [n_timings] Times of stages, rank 0 */
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

/* True if there are other ranks; else no function of MPI may be called, since it may not have been started. */
static inline bool kz_ranks_several(const kz_ranks *ranks) {
  return ranks && ranks->size > 1;
}

/* Installs handlers that record signals that ask for a stop. Call it before MPI_Init and again after it. */
void kz_signals_catch(void);
/* Returns the reason of a stop, "stopped by SIGTERM"; NULL if there is none. Safe in a signal handler. */
const char *kz_signals_caught(void);
