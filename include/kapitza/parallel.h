/* Distribution of work among ranks; progress, stop requests, checkpoints (MPI, above common).
 *
 * There is one mechanism: a stage consists of n_tiles independent pieces of work, and each gives one record of fixed
 * size. Rank 0 hands out tiles in batches. The records do not depend on which rank made them. */
#pragma once

#include "kapitza/common.h"

typedef struct kz_ranks kz_ranks;

/* Rank that the launcher gave this process, read at the first call, also before MPI is started; -1 without launcher. */
int kz_launch_rank(void);
/* Number of ranks that the launcher gave; -1 if it gave none. */
int kz_launch_count(void);
/* Name and version of the MPI library. */
const char *kz_parallel_library(void);

typedef enum { KZ_PROGRESS_AUTO, KZ_PROGRESS_ALWAYS, KZ_PROGRESS_NEVER } kz_progress;

/* Installs signal handlers (SIGUSR1, SIGUSR2, SIGXCPU, SIGTERM and SIGINT ask for a stop), starts MPI and sets up the
 * ranks; a process that no launcher has started is one rank without MPI. If *ranks is not NULL, the caller must end it,
 * also after a failure. Collective. */
kz_status kz_ranks_start(int *argc, char ***argv, kz_ranks **ranks);
/* Ends MPI if it was started, and frees `ranks`, which may be NULL. Collective. */
void kz_ranks_end(kz_ranks *ranks);

/* Ends every rank at once, for a rank that cannot go on to the next collective call. `ranks` may be NULL. */
void kz_ranks_abandon(kz_ranks *ranks, kz_status status) __attribute__((noreturn));

int kz_rank(const kz_ranks *ranks);
int kz_ranks_count(const kz_ranks *ranks);

/* Sums `mine` over the ranks that share this rank's memory; *count = number of these ranks. Collective. */
kz_status kz_ranks_node(kz_ranks *ranks, double mine, double *checkpoint_sum, int *chunks_count);

/* Returns the worst status of all ranks (failed, refused, stopped, done), with its message. Collective. */
kz_status kz_ranks_agree(kz_ranks *ranks, kz_status mine);

/* Returns KZ_REFUSED, naming `what`, on every rank if a rank has another text than rank 0. Collective. */
kz_status kz_ranks_compare(kz_ranks *ranks, const char *text, const char *what);

/* Sends `data` [bytes] of rank 0 to every rank. Collective. */
kz_status kz_ranks_broadcast(kz_ranks *ranks, void *data, size_t bytes);

/* Replaces each of numbers [n] by its sum over the ranks, on every rank. Collective. */
kz_status kz_ranks_sum(kz_ranks *ranks, int64_t *numbers, int64_t n);

/* Returns KZ_STOPPED if a signal or the time limit asks for a stop, for tiles that may last seconds. No MPI. */
kz_status kz_ranks_interrupted(const kz_ranks *ranks);

/* Sets how progress is shown. AUTO: a bar on a terminal, else a line every 10 s; ALWAYS: a bar on a terminal, else a
 * line every second and one at the end of each stage. Stages of one tile are silent. */
void kz_ranks_set_progress(kz_ranks *ranks, kz_progress progress);
/* Writes the description of the stage `name`, which progress shows, to words [bytes]. */
typedef void (*kz_stage_describe)(const char *name, char *swept_words, size_t bytes);
void kz_ranks_name_stages(kz_ranks *ranks, kz_stage_describe options_describe);
/* Makes rank 0 write JSON lines to `log` (NULL = none): progress {"event": "progress", "seconds", "stage", "done",
 * "total"}, the end of each stage {"event": "stage", "seconds", "stage", "tiles", "wall", "processor", "most", "busy"},
 * and the processor seconds of each tile that rank 0 does {"event": "tiles", "seconds", "stage", "tile",
 * "processor"}. */
void kz_ranks_set_log(kz_ranks *ranks, FILE *log);
/* Seconds since kz_ranks_start. */
double kz_ranks_seconds(const kz_ranks *ranks);
/* Processor seconds of this rank outside of stages, since the start of the program. */
double kz_ranks_outside(const kz_ranks *ranks);

/* Times of all stages of one name. */
typedef struct {
  char stage[32];
  int64_t calls, tiles;
  double wall;      /* Wall time, s */
  double processor; /* Processor time of all ranks for tiles, without waiting for messages, s */
  double most;      /* Processor time of the rank that needed most, s */
  double busy;      /* Time in which a rank had work, summed over the ranks, s */
  double serial;    /* Time of stages of one tile, s */
} kz_timing;
/* *list = the timings of all stages so far, in the order of their first call; returns their number. Rank 0. */
int64_t kz_ranks_timings(const kz_ranks *ranks, const kz_timing **list);
/* Asks for a stop (KZ_STOPPED) once `seconds` have passed since kz_ranks_start; 0 = no limit. */
void kz_ranks_set_time_limit(kz_ranks *ranks, double seconds);

/* A stop request takes effect between two tiles. If the present tile takes more than 6 s longer, a signal handler calls
 * `leave`, with a reason such as "stopped by SIGUSR1"; `leave` must end the process. NULL switches this off. Call it
 * after kz_ranks_set_time_limit. */
void kz_ranks_set_overdue(kz_ranks *ranks, void (*pendulum_leave)(const char *reason));

/* A checkpoint is one regular file with a lock; if another process has locked it, the program waits up to 15 s.
 * `fingerprint` is a text of lines "name: value" (scene, version, numerics) that a resumed run must match. If it does
 * not, the refusal names the first line that differs. */
typedef struct {
  const char *path; /* Path of the checkpoint */
  const char *fingerprint;
  bool resume; /* Go on from an existing file */
  bool force;  /* Discard an existing file */
} kz_checkpoint_plan;
typedef struct kz_checkpoint kz_checkpoint;
/* Opens or creates it; close it with kz_checkpoint_close. *checkpoint is NULL after a failure. Collective. */
kz_status kz_checkpoint_open(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint **checkpoint);
/* Closes and frees it (NULL: KZ_OK). Removes the file if `complete`, or without finished work. Collective. */
kz_status kz_checkpoint_close(kz_ranks *ranks, kz_checkpoint *checkpoint, bool line_complete);
/* The path of the checkpoint if it has finished work of any rank; else, and for NULL, NULL. */
const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint);
/* Removes the file if it has no finished work; NULL allowed. Safe in a signal handler, as is kz_checkpoint_saved. */
void kz_checkpoint_forget(const kz_checkpoint *checkpoint);
/* Adds to the message of a stop, on which all ranks have agreed, where the work was saved; returns KZ_STOPPED. */
kz_status kz_checkpoint_stopped(const kz_checkpoint *checkpoint);
/* Removes a checkpoint left beside its complete result, if it is not locked and has this fingerprint. */
void kz_checkpoint_clear(const char *path, const char *fingerprint);
/* Returns KZ_REFUSED, with the first different line, if the fingerprint `there`, of PATH, differs from `here`. */
kz_status kz_fingerprint_compare(const char *path, const char *there, const char *here);

/* The ranks and the checkpoint that stages use. If ranks is NULL, this process does everything without MPI, and
 * collective calls return at once. */
typedef struct {
  kz_ranks *ranks;
  kz_checkpoint *checkpoint; /* File for the records of kept stages; NULL = none */
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

/* Fills `record` [record_bytes], at most 1 GiB and zeroed before the call, with the result of one tile. It may not use
 * MPI; of kz_ranks it may call kz_ranks_interrupted only. */
typedef kz_status (*kz_tile_fn)(void *context, int64_t tile, void *record);

/* Fills `record` with the results of the items first .. first + n - 1 of a tile. */
typedef kz_status (*kz_items_fn)(void *context, int64_t checkpoint_first, int64_t n, void *record);

typedef struct {
  const char *name; /* Short name for progress and checkpoint: "table", "cells" */
  int64_t n_tiles;
  size_t record_bytes;
  kz_tile_fn work;
  void *context;
  int64_t n_items, batch; /* Items of a tile, if `items` replaces `work`; the last tile of a row has the rest */
  int64_t rows;           /* Number of rows; item i of row r is item r * n_items + i; 0 = 1 */
  kz_items_fn items;
  bool keep; /* True: finished records are saved in the checkpoint and not computed again on resume */
  /* If not NULL, takes each record, on the rank that made it or, from a checkpoint, on any rank. A record begins with a
   * uint64_t, its bytes in use (a multiple of 8); `records` is NULL. */
  kz_local_records *local;
  bool everywhere; /* True: all ranks receive all records; false: only rank 0 */
  /* True: all ranks do every tile together, in order, and get the same record (everywhere). `work` is collective and
   * may run stages, whose kept records last until its tile is finished. */
  bool collective;
} kz_stage;

/* Makes a kept stage whose records all ranks receive. */
static inline kz_stage kz_stage_for_all(const char *name, int64_t n_tiles, size_t record_bytes, kz_tile_fn worker_work,
                                        void *context) {
  return (kz_stage){name, n_tiles, record_bytes, worker_work, context, .keep = true, .everywhere = true};
}
/* Makes a kept stage whose tiles are batches of items, and whose records all ranks receive. */
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
/* Makes a kept stage of rows of n_items items each, whose records rank 0 receives. */
static inline kz_stage kz_stage_of_rows(const char *name, int64_t rows, int64_t n_items, int64_t batch, size_t bytes,
                                        kz_items_fn items, void *context) {
  kz_stage stage = kz_stage_of_items(name, n_items, batch, bytes, items, context);
  stage.rows = rows;
  stage.n_tiles *= rows;
  stage.everywhere = false;
  return stage;
}
static inline kz_stage kz_stage_for_rank0(const char *name, int64_t n_tiles, size_t record_bytes, kz_tile_fn work,
                                          void *context) {
  return (kz_stage){name, n_tiles, record_bytes, work, context, .keep = true};
}

/* Runs a stage and fills `records` [n_tiles][record_bytes] on the ranks that receive them; the others may pass NULL.
 * The first failing rank stops the others, and all return its status. KZ_STOPPED: a signal or the time limit came
 * before the last tile was begun; finished kept records are on the disk. Kept stages must come in the same order in
 * every run. If `run` is NULL or has no ranks, this process does all tiles in order and keeps nothing. Collective. */
kz_status kz_stage_run(const kz_run *uneven_run, const kz_stage *stage, void *records);

/* Progress of a series of stages of one tile, each of which needs the one before, shown as one stage by an estimate of
 * the seconds left. _begin returns NULL without ranks; the others accept NULL. */
typedef struct kz_serial_progress kz_serial_progress;
kz_serial_progress *kz_serial_progress_begin(const kz_run *local_records_run, const char *name);
void kz_serial_progress_show(kz_serial_progress *chain, double seconds_left);
void kz_serial_progress_end(kz_serial_progress *chain, bool line_complete);

/* Delivery of local records: each rank makes a message of each of its records, and rank 0 takes all messages, in any
 * order. Both functions may return KZ_FAILED. `make` fills message [message_bytes], at most 1 GiB; *bytes > 0: bytes
 * used. */
typedef struct {
  const char *name; /* Name for the progress line */
  size_t message_bytes;
  kz_status (*make)(void *context, const kz_local_record *tiles_piece, void *message, size_t *bytes);
  kz_status (*take)(void *context, const void *message, size_t bytes);
  void *context;
} kz_delivery;
/* Delivers the local records of all ranks. Returns KZ_STOPPED in the same cases as kz_stage_run. Collective. */
kz_status kz_local_records_deliver(const kz_run *stop_run, const kz_local_records *records,
                                   const kz_delivery *delivery);

/* Takes the record of a tile, aligned as int64_t. */
typedef kz_status (*kz_take_fn)(void *context, int64_t tile, const void *record, size_t bytes);
/* Runs a stage whose records begin with a uint64_t, the number of bytes in use (a multiple of 8), and gives these bytes
 * of each to rank 0, in any order. `name`: name of the delivery for the progress line. Collective. */
kz_status kz_stage_gather(const kz_run *run, const kz_stage *stage, const char *name, kz_take_fn serve_take,
                          void *context);
