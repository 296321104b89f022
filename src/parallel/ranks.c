/* All ranks together: start, end, agreement, broadcast. */
#include "ranks.h"

#include <mpi.h>
#include <signal.h>
#include <unistd.h>

#include "bytes.h"

/* ---- what is known of the launcher before MPI is started ---- */

/* Returns the first of `names` in the environment as a number; -1 if there is none. */
static int first_number(const char *const names[], size_t n) {
  for (size_t i = 0; i < n; ++i) {
    const char *value = getenv(names[i]);
    if (value) return atoi(value);
  }
  return -1;
}

/* Rank and number of ranks from the launcher, read once before MPI_Init, which sets some of these names itself.
 * (SLURM_PROCID is no sign of a launcher: batch scripts have it too.) */
static struct {
  int rank, count;
} launch;

static void find_launch(void) {
  const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  const char *const counts[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};
  launch.rank = first_number(ranks, sizeof ranks / sizeof *ranks);
  launch.count = first_number(counts, sizeof counts / sizeof *counts);
}

static void read_launch(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, find_launch);
}

int kz_launch_rank(void) {
  read_launch();
  return launch.rank;
}

int kz_launch_count(void) {
  read_launch();
  return launch.count;
}

/* Prefixes of variables that launchers set: a superfluous one costs MPI's start, without one processes run alone. */
static const char *const launchers[] = {"PMI",      "PMIX_",   "OMPI_COMM_WORLD", "ORTE_",     "SLURM_STEP",
                                        "ALPS_APP", "PALS_",   "FLUX_",           "MPI_LOCAL", "MPIRUN_RANK",
                                        "MV2_COMM", "HYDRA",   "LSB_MCPU",        "MP_CHILD",  "PBS_TASKNUM",
                                        "JSM_",     "MPIRANK", "MPT_LRANK"};

extern char **environ;

/* True if a launcher has started this process; else MPI, which takes longer than a small run, is not started. Processes
 * of an unknown launcher run alone, and the lock of the checkpoint lets one of them write. */
static bool is_launched(void) {
  for (char **variable = environ; *variable; variable++)
    for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++)
      if (strncmp(*variable, launchers[i], strlen(launchers[i])) == 0) return true;
  return false;
}

static char library[MPI_MAX_LIBRARY_VERSION_STRING];

static void name_library(void) {
  int length = 0;
  if (MPI_Get_library_version(library, &length) != MPI_SUCCESS) strcpy(library, "unknown MPI");
  char *end = library;
  for (const char *c = library; *c && *c != ',' && *c != '\n'; c++) /* MPICH writes columns: one blank is enough */
    if (*c != ' ' && *c != '\t')
      *end++ = *c;
    else if (end > library && end[-1] != ' ')
      *end++ = ' ';
  *end = '\0';
}

const char *kz_parallel_library(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, name_library);
  return library;
}

enum { ABANDON_SECONDS = 5 };
static const size_t CHUNK_BYTES = (size_t)1 << 30; /* MPI counts are int */

kz_status kz_mpi_fail(int code, const char *file, int line) {
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  if (MPI_Error_string(code, text, &length) != MPI_SUCCESS) snprintf(text, sizeof text, "MPI error %d", code);
  const char *base = strrchr(file, '/');
  return kz_fail(KZ_FAILED, "MPI: %s (%s:%d)", text, base ? base + 1 : file, line);
}

static kz_status connect_ranks(kz_ranks *ranks) {
  KZ_MPI(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN));
  KZ_MPI(MPI_Comm_dup(MPI_COMM_WORLD, &ranks->comm));
  KZ_MPI(MPI_Comm_set_errhandler(ranks->comm, MPI_ERRORS_RETURN));
  KZ_MPI(MPI_Comm_rank(ranks->comm, &ranks->rank));
  KZ_MPI(MPI_Comm_size(ranks->comm, &ranks->size));
  if (ranks->size == 1 && kz_launch_count() > 1)
    return kz_fail(KZ_REFUSED,
                   "a launcher of another MPI started %d processes, each of which would run alone; start them by the "
                   "mpiexec of this "
                   "program's MPI, %s",
                   kz_launch_count(), kz_parallel_library());
  return KZ_OK;
}

kz_status kz_ranks_start(int *argc, char ***argv, kz_ranks **ranks) {
  kz_signals_catch();
  kz_launch_rank(); /* remembers what the launcher said, before MPI_Init writes the same names */
  kz_ranks *started =
      kz_calloc(1, sizeof *started); /* before MPI_Init, so that no rank waits for one that fails here */
  started->comm = MPI_COMM_NULL;
  started->size = 1;
  started->start = kz_clock();
  started->mutex = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
  *ranks = started;
  if (!is_launched()) return KZ_OK;
  KZ_MPI(MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &started->thread_level));
  kz_signals_catch();
  started->start = kz_clock();
  return connect_ranks(started);
}

void kz_ranks_end(kz_ranks *ranks) {
  if (ranks) {
    free(ranks->timings);
    if (ranks->terminal) fclose(ranks->terminal);
    if (ranks->comm != MPI_COMM_NULL) MPI_Comm_free(&ranks->comm);
    free(ranks);
  }
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  if (begun && !ended) MPI_Finalize();
}

static void exit_failed(int number) {
  (void)number;
  _exit(KZ_FAILED);
}

void kz_ranks_abandon(kz_ranks *ranks, kz_status status) {
  int ended = 1;
  if (kz_ranks_several(ranks) && MPI_Finalized(&ended) == MPI_SUCCESS && !ended) {
    signal(SIGALRM, exit_failed); /* MPI may also be out of memory */
    alarm(ABANDON_SECONDS);
    pthread_mutex_lock(&ranks->mutex);
    MPI_Abort(MPI_COMM_WORLD, status);
  }
  _exit(status);
}

int kz_rank(const kz_ranks *ranks) {
  return ranks ? ranks->rank : 0;
}

int kz_ranks_count(const kz_ranks *ranks) {
  return ranks ? ranks->size : 1;
}

kz_status kz_ranks_node(kz_ranks *ranks, double mine, double *sum, int *count) {
  MPI_Comm node;
  *sum = mine;
  *count = 1;
  if (!kz_ranks_several(ranks)) return KZ_OK;
  KZ_MPI(MPI_Comm_split_type(ranks->comm, MPI_COMM_TYPE_SHARED, ranks->rank, MPI_INFO_NULL, &node));
  KZ_MPI(MPI_Comm_size(node, count));
  KZ_MPI(MPI_Allreduce(&mine, sum, 1, MPI_DOUBLE, MPI_SUM, node));
  KZ_MPI(MPI_Comm_free(&node));
  return KZ_OK;
}

static int severity_of(kz_status status) {
  const kz_status order[] = {KZ_OK, KZ_STOPPED, KZ_REFUSED, KZ_FAILED};
  int place = 3;
  while (place > 0 && order[place] != status) --place;
  return place;
}

kz_status kz_ranks_agree(kz_ranks *ranks, kz_status mine) {
  if (!kz_ranks_several(ranks)) return mine;
  struct {
    int severity, rank;
  } own = {severity_of(mine), ranks->rank}, worst;
  KZ_MPI(MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MAXLOC, ranks->comm));
  if (worst.severity == 0) return KZ_OK;
  struct {
    kz_status status;
    char message[KZ_MESSAGE_BYTES];
  } failure = {.status = mine};
  snprintf(failure.message, sizeof failure.message, "%s", kz_message());
  KZ_MPI(MPI_Bcast(&failure, sizeof failure, MPI_BYTE, worst.rank, ranks->comm));
  kz_message_clear();
  return kz_fail(failure.status, "%s", failure.message);
}

kz_status kz_ranks_compare(kz_ranks *ranks, const char *text, const char *what) {
  const uint64_t own = kz_bytes_checksum(0, text, strlen(text));
  uint64_t first = own;
  KZ_TRY(kz_ranks_broadcast(ranks, &first, sizeof first));
  return kz_ranks_agree(ranks, own == first
                                   ? KZ_OK
                                   : kz_fail(KZ_REFUSED, "rank %d has another %s than rank 0; give every rank the same",
                                             ranks->rank, what));
}

kz_status kz_ranks_broadcast(kz_ranks *ranks, void *data, size_t bytes) {
  for (size_t sent = 0; kz_ranks_several(ranks) && sent < bytes; sent += CHUNK_BYTES) {
    const size_t left = bytes - sent;
    KZ_MPI(MPI_Bcast((char *)data + sent, (int)kz_smaller(left, CHUNK_BYTES), MPI_BYTE, 0, ranks->comm));
  }
  return KZ_OK;
}

kz_status kz_ranks_sum(kz_ranks *ranks, int64_t *numbers, int64_t n) {
  static const int64_t part = (int64_t)1 << 27; /* MPI counts are int */
  for (int64_t done = 0; kz_ranks_several(ranks) && done < n; done += part) {
    const int count = (int)(n - done < part ? n - done : part);
    KZ_MPI(MPI_Allreduce(MPI_IN_PLACE, numbers + done, count, MPI_INT64_T, MPI_SUM, ranks->comm));
  }
  return KZ_OK;
}

void kz_ranks_set_progress(kz_ranks *ranks, kz_progress progress) {
  ranks->progress = progress;
}

void kz_ranks_name_stages(kz_ranks *ranks, kz_stage_describe describe) {
  ranks->describe = describe;
}

void kz_ranks_set_time_limit(kz_ranks *ranks, double seconds) {
  ranks->limit = seconds;
}

kz_status kz_ranks_interrupted(const kz_ranks *ranks) {
  const char *reason = kz_signals_caught();
  if (reason) return kz_fail(KZ_STOPPED, "%s", reason);
  if (ranks && ranks->limit > 0 && kz_clock() - ranks->start >= ranks->limit)
    return kz_fail(KZ_STOPPED, "stopped by the time limit of %g s", ranks->limit);
  return KZ_OK;
}
