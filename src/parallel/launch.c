/* How this process was started, found out without MPI. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include "ranks.h"

/* The first of `names` that the environment holds, as a number; -1 where it holds none. */
static int first_number(const char *const names[], size_t n) {
  for (size_t i = 0; i < n; ++i) {
    const char *value = getenv(names[i]);
    if (value) return atoi(value);
  }
  return -1;
}

/* MPI_Init writes some of these names by itself where no launcher did: they are looked for once, before it. SLURM_PROCID is no
 * such sign: a batch script and a shell within a job have it too. */
static struct {
  bool known;
  int rank, count;
} launch;

static void look(void) {
  const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  const char *const counts[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};
  if (launch.known) return;
  launch.rank = first_number(ranks, sizeof ranks / sizeof *ranks);
  launch.count = first_number(counts, sizeof counts / sizeof *counts);
  launch.known = true;
}

int kz_launch_rank(void) {
  look();
  return launch.rank;
}

int kz_launch_count(void) {
  look();
  return launch.count;
}

/* Beginnings of what launchers tell the processes that they start: one too many costs MPI's start, one too few makes each process run
 * alone. */
static const char *const launchers[] = {"PMI",      "PMIX_",    "OMPI_COMM_WORLD", "ORTE_",       "SLURM_STEP", "ALPS_APP",
                                        "PALS_",    "FLUX_",    "MPI_LOCAL",       "MPIRUN_RANK", "MV2_COMM",   "HYDRA",
                                        "LSB_MCPU", "MP_CHILD", "PBS_TASKNUM",     "JSM_",        "MPIRANK",    "MPT_LRANK"};

extern char **environ;

bool kz_is_launched(void) {
  for (char **variable = environ; *variable; variable++)
    for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++)
      if (strncmp(*variable, launchers[i], strlen(launchers[i])) == 0) return true;
  return false;
}

const char *kz_parallel_library(void) {
  static char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  if (MPI_Get_library_version(text, &length) != MPI_SUCCESS) return "unknown MPI";
  char *end = text;
  for (const char *c = text; *c && *c != ',' && *c != '\n'; c++) /* MPICH writes columns: one blank is enough */
    if (*c != ' ' && *c != '\t')
      *end++ = *c;
    else if (end > text && end[-1] != ' ')
      *end++ = ' ';
  *end = '\0';
  return text;
}
