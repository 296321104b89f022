/* parallel: distribution of work among ranks; progress, stop requests, checkpoints (MPI; layer 2).
 *
 * There is one mechanism: a stage consists of n_tiles independent pieces of work, and each gives one record of fixed size. Rank 0 hands
 * out tiles in batches. The records do not depend on which rank made them. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "kapitza/common.h"

typedef struct kz_ranks kz_ranks;

/* These three work before MPI is started. The rank of this process that the launcher gave it, read at the first call; -1 if there is no
 * launcher. */
int kz_launch_rank(void);
/* The number of ranks that the launcher gives; -1 if it gives none. */
int kz_launch_count(void);
/* Name and version of the MPI library. */
const char *kz_parallel_library(void);

typedef enum { KZ_PROGRESS_AUTO, KZ_PROGRESS_ALWAYS, KZ_PROGRESS_NEVER } kz_progress;

/* Installs signal handlers (SIGUSR1, SIGUSR2, SIGXCPU, SIGTERM and SIGINT ask for a stop), starts MPI and sets up the ranks; a process that
 * no launcher has started is one rank without MPI. If *ranks is not NULL, the caller must end it, also after a failure. Collective. */
kz_status kz_ranks_start(int *argc, char ***argv, kz_ranks **ranks);
/* Ends MPI if it was started, and frees `ranks`, which may be NULL. Collective. */
void kz_ranks_end(kz_ranks *ranks);

/* Ends every rank at once and does not return: for a rank that cannot go on to the next collective call. `ranks` may be NULL. */
void kz_ranks_abandon(kz_ranks *ranks, kz_status status) __attribute__((noreturn));

int kz_rank(const kz_ranks *ranks);
int kz_ranks_count(const kz_ranks *ranks);

/* *sum = the sum of `mine` over the ranks that share this rank's memory; *count = the number of these ranks. Collective. */
kz_status kz_ranks_node(kz_ranks *ranks, double mine, double *sum, int *count);

/* The worst status of all ranks (failed, refused, stopped, done), with that rank's message on every rank. Collective. */
kz_status kz_ranks_agree(kz_ranks *ranks, kz_status mine);

/* KZ_REFUSED on every rank if a rank has another text than rank 0; the message names `what` as the thing that differs. Collective. */
kz_status kz_ranks_compare(kz_ranks *ranks, const char *text, const char *what);

/* Sends `data` [bytes] of rank 0 to every rank. Collective. */
kz_status kz_ranks_broadcast(kz_ranks *ranks, void *data, size_t bytes);

/* Replaces each of numbers [n] by its sum over the ranks, on every rank. Collective. */
kz_status kz_ranks_sum(kz_ranks *ranks, int64_t *numbers, int64_t n);

/* KZ_STOPPED if a signal or the time limit asks for a stop. A tile that may last seconds calls this and returns the status. No MPI. */
kz_status kz_ranks_interrupted(const kz_ranks *ranks);

/* auto: a bar on a terminal, else a line every 10 s. always: a bar on a terminal, else a line every second and one at the end of each
 * stage. never: nothing. Stages of one tile are silent. */
void kz_ranks_set_progress(kz_ranks *ranks, kz_progress progress);
/* Progress names stages by what `describe` writes for their names to words [bytes]; without it by these names. */
typedef void (*kz_stage_describe)(const char *name, char *words, size_t bytes);
void kz_ranks_name_stages(kz_ranks *ranks, kz_stage_describe describe);
/* Makes rank 0 write JSON lines to `log` (NULL = none): progress {"event": "progress", "seconds", "stage", "done", "total"}, the end of each
 * stage {"event": "stage", "seconds", "stage", "tiles", "wall", "processor", "most", "busy"}, and the processor seconds of each tile that
 * rank 0 does {"event": "tiles", "seconds", "stage", "tile", "processor"}. */
void kz_ranks_set_log(kz_ranks *ranks, FILE *log);
/* Seconds since kz_ranks_start. */
double kz_ranks_seconds(const kz_ranks *ranks);
/* Processor seconds of this rank outside of stages, since the start of the program. */
double kz_ranks_outside(const kz_ranks *ranks);

/* The times of all stages of one name. */
typedef struct {
  char stage[32];
  int64_t calls, tiles;
  double wall;      /* s */
  double processor; /* s of processor time of all ranks for tiles, without waiting for messages */
  double most;      /* s, the same of the rank that needed most */
  double busy;      /* s in which a rank had work, summed over the ranks */
  double serial;    /* s in which only one rank had work: stages of one tile */
} kz_timing;
/* *list = the timings of all stages so far, in the order of their first call; returns their number. Rank 0. */
int64_t kz_ranks_timings(const kz_ranks *ranks, const kz_timing **list);
/* Asks for a stop (KZ_STOPPED) once `seconds` have passed since kz_ranks_start; 0 = no limit. */
void kz_ranks_set_time_limit(kz_ranks *ranks, double seconds);

/* A stop request takes effect between two tiles. If the present tile takes more than 6 s longer, a signal handler calls `leave`, with a
 * reason such as "stopped by SIGUSR1"; `leave` must end the process. NULL switches this off. Call it after kz_ranks_set_time_limit. */
void kz_ranks_set_overdue(kz_ranks *ranks, void (*leave)(const char *reason));

/* A checkpoint is one regular file with a lock; if another process has locked it, the program waits up to 15 s. `fingerprint` is a text of
 * lines "name: value" (scene, version, numerics) that a resumed run must match. If it does not, the refusal names the first line that
 * differs. */
typedef struct {
  const char *path; /* of the checkpoint itself */
  const char *fingerprint;
  bool resume; /* go on from an existing file */
  bool force;  /* discard an existing file */
} kz_checkpoint_plan;
typedef struct kz_checkpoint kz_checkpoint;
/* Opens or creates it; close it with kz_checkpoint_close. *checkpoint is NULL after a failure. Collective. */
kz_status kz_checkpoint_open(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint **checkpoint);
/* Closes and frees it (NULL: returns KZ_OK). Removes the file if `complete`, or if it has no finished work. Collective. */
kz_status kz_checkpoint_close(kz_ranks *ranks, kz_checkpoint *checkpoint, bool complete);
/* The path of the checkpoint if it has finished work of any rank; else, and for NULL, NULL. */
const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint);
/* Removes the file if it has no finished work; `checkpoint` may be NULL. Safe in a signal handler, as is kz_checkpoint_saved. */
void kz_checkpoint_forget(const kz_checkpoint *checkpoint);
/* Adds to the message of a stop whether, and where, the finished work was saved; returns KZ_STOPPED. Called after all ranks have agreed. */
kz_status kz_checkpoint_stopped(const kz_checkpoint *checkpoint);
/* Removes a checkpoint that is left beside its complete result, if no process has locked it and it has this fingerprint. */
void kz_checkpoint_clear(const char *path, const char *fingerprint);
/* KZ_REFUSED if the fingerprint `there`, of the file PATH, differs from `here`; the message has the first line that differs. */
kz_status kz_fingerprint_compare(const char *path, const char *there, const char *here);

/* The ranks and the checkpoint that stages use. If ranks is NULL, this process does everything without MPI, and collective calls return at
 * once. */
typedef struct {
  kz_ranks *ranks;
  kz_checkpoint *checkpoint; /* for the records of kept stages; NULL = nothing is kept */
} kz_run;

/* Records of varying length that stay on the rank that made them. */
typedef struct {
  int64_t tile;
  size_t bytes;
  void *data;
} kz_local_record;
typedef struct {
  int64_t n, capacity;
  kz_local_record *list; /* [n], in no order */
} kz_local_records;
void kz_local_records_add(kz_local_records *records, int64_t tile, const void *data, size_t bytes);
void kz_local_records_free(kz_local_records *records);

/* Fills `record` [record_bytes], at most 1 GiB and zeroed before the call, with the result of one tile. It may not use MPI; of kz_ranks it
 * may call kz_ranks_interrupted only. */
typedef kz_status (*kz_tile_fn)(void *context, int64_t tile, void *record);

/* The same for the items first .. first + n - 1 of a tile. */
typedef kz_status (*kz_items_fn)(void *context, int64_t first, int64_t n, void *record);

typedef struct {
  const char *name; /* short, for the progress line and the checkpoint: "table", "cells" */
  int64_t n_tiles;
  size_t record_bytes;
  kz_tile_fn work;
  void *context;
  int64_t n_items,
      batch;    /* with `items` in place of `work`: a tile is `batch` items, the last one of a row those that are left */
  int64_t rows; /* item i of row r has the number r * n_items + i; 0 = 1 */
  kz_items_fn items;
  bool keep; /* finished records are saved in the checkpoint and not computed again on resume */
  kz_local_records
      *local;      /* not NULL: a record begins with a uint64_t, the number of bytes in use (a multiple of 8). It is added to
                        this list, on the rank that made it or, from a checkpoint, on any rank; `records` is NULL then */
  bool everywhere; /* true: all ranks receive all records; false: only rank 0 */
  bool
      collective; /* true: all ranks do every tile together, in order, and get the same record (everywhere). `work` is collective
                      and may run stages, whose kept records last until its tile is finished */
} kz_stage;

/* A kept stage whose records all ranks receive; one whose records rank 0 alone receives. */
static inline kz_stage kz_stage_for_all(const char *name, int64_t n_tiles, size_t record_bytes, kz_tile_fn work,
                                        void *context) {
  return (kz_stage){name, n_tiles, record_bytes, work, context, .keep = true, .everywhere = true};
}
/* A kept stage whose tiles are batches of items, and whose records all ranks receive. */
static inline kz_stage kz_stage_of_items(const char *name, int64_t n_items, int64_t batch, size_t record_bytes,
                                         kz_items_fn items, void *context) {
  return (kz_stage){.name = name,
                    .n_tiles = (n_items + batch - 1) / batch,
                    .record_bytes = record_bytes,
                    .context = context,
                    .n_items = n_items,
                    .batch = batch,
                    .items = items,
                    .keep = true,
                    .everywhere = true};
}
/* The same for rows of n_items items each, and rank 0 alone receives the records. */
static inline kz_stage kz_stage_of_rows(const char *name, int64_t rows, int64_t n_items, int64_t batch, size_t record_bytes,
                                        kz_items_fn items, void *context) {
  kz_stage stage = kz_stage_of_items(name, n_items, batch, record_bytes, items, context);
  stage.rows = rows;
  stage.n_tiles *= rows;
  stage.everywhere = false;
  return stage;
}
static inline kz_stage kz_stage_for_rank0(const char *name, int64_t n_tiles, size_t record_bytes, kz_tile_fn work,
                                          void *context) {
  return (kz_stage){name, n_tiles, record_bytes, work, context, .keep = true};
}

/* Runs a stage and fills `records` [n_tiles][record_bytes] on the ranks that receive them; the others may pass NULL. The first failing rank
 * stops the others, and all return its status. KZ_STOPPED: a signal or the time limit came before the last tile was begun; finished kept
 * records are on the disk. Kept stages must come in the same order in every run. If `run` is NULL or has no ranks, this process does all
 * tiles in order and keeps nothing. Collective. */
kz_status kz_stage_run(const kz_run *run, const kz_stage *stage, void *records);

/* A chain of stages of one tile, each of which needs the one before, shows its progress as one stage, by an estimate of the seconds left.
 * Returns NULL without ranks; the other calls accept NULL. */
typedef struct kz_serial_progress kz_serial_progress;
kz_serial_progress *kz_serial_progress_begin(const kz_run *run, const char *name);
void kz_serial_progress_show(kz_serial_progress *chain, double seconds_left);
void kz_serial_progress_end(kz_serial_progress *chain, bool complete);

/* How local records are delivered: each rank makes a message of each of its records, and rank 0 takes all messages, in any order. Both
 * functions may return KZ_FAILED. `make` fills message [message_bytes], at most 1 GiB; *bytes = the number of bytes in use, more than 0. */
typedef struct {
  const char *name; /* for the progress line */
  size_t message_bytes;
  kz_status (*make)(void *context, const kz_local_record *piece, void *message, size_t *bytes);
  kz_status (*take)(void *context, const void *message, size_t bytes);
  void *context;
} kz_delivery;
/* Delivers the local records of all ranks. Returns KZ_STOPPED in the same cases as kz_stage_run. Collective. */
kz_status kz_local_records_deliver(const kz_run *run, const kz_local_records *records, const kz_delivery *delivery);

/* Takes the record of a tile, aligned as int64_t. */
typedef kz_status (*kz_take_fn)(void *context, int64_t tile, const void *record, size_t bytes);
/* Runs a stage whose records begin with a uint64_t, the number of bytes in use (a multiple of 8), and gives these bytes of each to rank 0, in
 * any order. `name`: of the delivery, for the progress line. Collective. */
kz_status kz_stage_gather(const kz_run *run, const kz_stage *stage, const char *name, kz_take_fn take, void *context);
