/* The team of all ranks: start, end, agreement, broadcast. */
#include "team.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bytes.h"

enum { MESSAGE_BYTES = 2048, ABANDON_SECONDS = 5 };
static const size_t CHUNK_BYTES = (size_t)1 << 30; /* MPI counts are int */

double kz_clock(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

kz_status kz_mpi_fail(int code, const char *file, int line) {
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  if (MPI_Error_string(code, text, &length) != MPI_SUCCESS) snprintf(text, sizeof text, "MPI error %d", code);
  const char *base = strrchr(file, '/');
  return kz_fail(KZ_FAILED, "MPI: %s (%s:%d)", text, base ? base + 1 : file, line);
}

static kz_status connect_ranks(kz_team *team) {
  KZ_MPI(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN));
  KZ_MPI(MPI_Comm_dup(MPI_COMM_WORLD, &team->comm));
  KZ_MPI(MPI_Comm_set_errhandler(team->comm, MPI_ERRORS_RETURN));
  KZ_MPI(MPI_Comm_rank(team->comm, &team->rank));
  KZ_MPI(MPI_Comm_size(team->comm, &team->size));
  return KZ_OK;
}

kz_status kz_team_start(int *argc, char ***argv, kz_team **team) {
  kz_signals_catch();
  kz_launch_rank();
  kz_team *started = calloc(1, sizeof *started); /* before MPI: a rank that never joins keeps nobody waiting */
  if (!started) return kz_fail(KZ_FAILED, "out of memory while starting");
  started->comm = MPI_COMM_NULL;
  started->mutex = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
  started->checkpoint.file = -1;
  *team = started;
  KZ_MPI(MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &started->thread_level));
  kz_signals_catch();
  started->start = kz_clock();
  return connect_ranks(started);
}

void kz_team_end(kz_team *team) {
  if (team) {
    kz_checkpoint_release(&team->checkpoint);
    if (team->terminal) fclose(team->terminal);
    if (team->comm != MPI_COMM_NULL) MPI_Comm_free(&team->comm);
    free(team);
  }
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  if (begun && !ended) MPI_Finalize();
}

static void give_up(int number) {
  (void)number;
  _exit(KZ_FAILED);
}

void kz_team_abandon(kz_team *team, kz_status status) {
  int ended = 1;
  if (team && MPI_Finalized(&ended) == MPI_SUCCESS && !ended && team->size > 1) {
    signal(SIGALRM, give_up); /* MPI may lack what this rank lacks */
    alarm(ABANDON_SECONDS);
    pthread_mutex_lock(&team->mutex);
    MPI_Abort(MPI_COMM_WORLD, status);
  }
  _exit(status);
}

const char *kz_team_saved(const kz_team *team) {
  return kz_checkpoint_holds_work(&team->checkpoint) ? team->checkpoint.path : NULL;
}

void kz_team_forget(const kz_team *team) {
  kz_checkpoint_forget(&team->checkpoint);
}

int kz_team_rank(const kz_team *team) {
  return team->rank;
}

int kz_team_size(const kz_team *team) {
  return team->size;
}

kz_status kz_team_node(kz_team *team, double mine, double *sum, int *ranks) {
  MPI_Comm node;
  KZ_MPI(MPI_Comm_split_type(team->comm, MPI_COMM_TYPE_SHARED, team->rank, MPI_INFO_NULL, &node));
  KZ_MPI(MPI_Comm_size(node, ranks));
  KZ_MPI(MPI_Allreduce(&mine, sum, 1, MPI_DOUBLE, MPI_SUM, node));
  KZ_MPI(MPI_Comm_free(&node));
  return KZ_OK;
}

static int severity(kz_status status) {
  const kz_status order[] = {KZ_OK, KZ_STOPPED, KZ_REFUSED, KZ_FAILED};
  int place = 3;
  while (place > 0 && order[place] != status) --place;
  return place;
}

kz_status kz_team_agree(kz_team *team, kz_status mine) {
  struct {
    int severity, rank;
  } own = {severity(mine), team->rank}, worst;
  KZ_MPI(MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MAXLOC, team->comm));
  if (worst.severity == 0) return KZ_OK;
  struct {
    kz_status status;
    char message[MESSAGE_BYTES];
  } told = {.status = mine};
  snprintf(told.message, sizeof told.message, "%s", kz_message());
  KZ_MPI(MPI_Bcast(&told, sizeof told, MPI_BYTE, worst.rank, team->comm));
  kz_message_clear();
  return kz_fail(told.status, "%s", told.message);
}

kz_status kz_team_compare(kz_team *team, const char *text, const char *what) {
  const uint64_t own = kz_bytes_checksum(0, text, strlen(text));
  uint64_t first = own;
  KZ_TRY(kz_team_broadcast(team, &first, sizeof first));
  return kz_team_agree(team, own == first ? KZ_OK
                                          : kz_fail(KZ_REFUSED, "rank %d has another %s than rank 0; the same for every rank",
                                                    team->rank, what));
}

kz_status kz_team_broadcast(kz_team *team, void *data, size_t bytes) {
  for (size_t sent = 0; sent < bytes; sent += CHUNK_BYTES) {
    const size_t left = bytes - sent;
    KZ_MPI(MPI_Bcast((char *)data + sent, (int)(left < CHUNK_BYTES ? left : CHUNK_BYTES), MPI_BYTE, 0, team->comm));
  }
  return KZ_OK;
}

void kz_team_set_progress(kz_team *team, kz_progress progress) {
  team->progress = progress;
}

void kz_team_set_time_limit(kz_team *team, double seconds) {
  team->limit = seconds;
}

kz_status kz_team_interrupted(const kz_team *team) {
  const char *signal = kz_signals_caught();
  if (signal) return kz_fail(KZ_STOPPED, "stopped by %s", signal);
  if (team->limit > 0 && kz_clock() - team->start >= team->limit)
    return kz_fail(KZ_STOPPED, "stopped by the time limit of %g s", team->limit);
  return KZ_OK;
}

kz_status kz_team_stopped(const kz_team *team) {
  char reason[MESSAGE_BYTES];
  const char *saved = kz_team_saved(team);
  snprintf(reason, sizeof reason, "%s", kz_message());
  kz_message_clear();
  return kz_fail(KZ_STOPPED, "%s; %s%s", reason, saved ? "finished work is in " : "nothing was saved", saved ? saved : "");
}
