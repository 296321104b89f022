/* What can be known without starting MPI. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/parallel.h"

/* SLURM_PROCID is no such sign: a batch script and a shell within a job have it too. */
static int told_rank(void) {
  const char *const names[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
    const char *value = getenv(names[i]);
    if (value) return atoi(value);
  }
  return -1;
}

int kz_launch_rank(void) {
  static bool known;
  static int rank;
  if (!known) rank = told_rank(); /* MPI_Init writes some of these names by itself where no launcher did */
  known = true;
  return rank;
}

const char *kz_parallel_library(void) {
  static char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  if (MPI_Get_library_version(text, &length) != MPI_SUCCESS) return "unknown MPI";
  text[strcspn(text, ",\n")] = '\0';
  return text;
}
