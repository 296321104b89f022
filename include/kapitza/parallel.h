/* parallel: who works on which tile; progress, stop requests, checkpoints (MPI; layer 2).
 *
 * One mechanism: a stage is n_tiles independent pieces of work, each giving one record of fixed size. Ranks take tiles in
 * batches from rank 0. The result depends on the tiles alone, never on who did them. */
#ifndef KAPITZA_PARALLEL_H
#define KAPITZA_PARALLEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "kapitza/common.h"

typedef struct kz_ranks kz_ranks;

/* What can be known without starting MPI: this process's rank as its launcher told it at the first call (-1: none did), and the
 * library. */
int kz_launch_rank(void);
/* How many ranks the launcher says that there are; -1 where it says nothing. */
int kz_launch_count(void);
const char *kz_parallel_library(void);

typedef enum { KZ_PROGRESS_AUTO, KZ_PROGRESS_ALWAYS, KZ_PROGRESS_NEVER } kz_progress;

/* Starts MPI (signal handlers first: SIGUSR1, SIGUSR2, SIGXCPU, SIGTERM and SIGINT ask for a stop) and sets up the ranks.
 * `ranks` is NULL or must be ended also where this fails. Collective. */
kz_status kz_ranks_start(int *argc, char ***argv, kz_ranks **ranks);
/* Frees `ranks` (NULL too) and leaves through MPI_Finalize. Collective. */
void kz_ranks_end(kz_ranks *ranks);

/* Ends every rank at once, for one that cannot go on to the next collective call; does not return. `ranks` may be NULL. */
void kz_ranks_abandon(kz_ranks *ranks, kz_status status) __attribute__((noreturn));

int kz_rank(const kz_ranks *ranks);
int kz_ranks_count(const kz_ranks *ranks);

/* The sum of `mine` over the ranks that share this rank's memory, and how many they are. Collective. */
kz_status kz_ranks_node(kz_ranks *ranks, double mine, double *sum, int *count);

/* The worst status of all ranks (failed, refused, stopped, done), with that rank's message on every rank. Collective. */
kz_status kz_ranks_agree(kz_ranks *ranks, kz_status mine);

/* KZ_REFUSED on every rank where one has another text than rank 0; `what` is said to differ. Collective. */
kz_status kz_ranks_compare(kz_ranks *ranks, const char *text, const char *what);

/* Bytes of rank 0 to every rank. Collective. */
kz_status kz_ranks_broadcast(kz_ranks *ranks, void *data, size_t bytes);

/* Sums of each of n numbers over the ranks, on every rank. Collective. */
kz_status kz_ranks_sum(kz_ranks *ranks, int64_t *numbers, int64_t n);

/* KZ_STOPPED where a signal or the time limit asks for a stop; a tile that may last seconds returns it. No MPI. */
kz_status kz_ranks_interrupted(const kz_ranks *ranks);

/* auto: a bar where a person's terminal is found, else a line every 10 s; always: where no terminal is, a line every
 * second and one at the end of each stage; never: nothing. Stages of one tile are silent. */
void kz_ranks_set_progress(kz_ranks *ranks, kz_progress progress);
/* Progress and the end of each stage as JSON lines (rank 0; NULL: none): {"event": "progress", "seconds", "stage", "done", "total"},
 * {"event": "stage", "seconds", "stage", "tiles", "wall", "processor", "most", "busy"}; and
 * processor seconds of the tiles that rank 0 does: {"event": "tiles", "seconds", "stage", "tile", "processor"}. */
void kz_ranks_set_log(kz_ranks *ranks, FILE *log);
/* Seconds since kz_ranks_start. */
double kz_ranks_seconds(const kz_ranks *ranks);
/* Processor seconds of this rank outside of stages, from the start of the program on. */
double kz_ranks_outside(const kz_ranks *ranks);

/* What the stages of one name took. */
typedef struct {
  char stage[32];
  int64_t calls, tiles;
  double wall;      /* s */
  double processor; /* s, of all ranks, for tiles: without those in which MPI waits */
  double most;      /* s, the same of the rank that needed most */
  double busy;      /* s in which a rank had work, of all ranks */
  double serial;    /* s in which only one had: stages of one tile */
} kz_timing;
/* Those of all stages so far, in the order of their first; how many. Rank 0. */
int64_t kz_ranks_timings(const kz_ranks *ranks, const kz_timing **list);
/* Stop (KZ_STOPPED) once `seconds` have passed since kz_ranks_start; 0 = no limit. */
void kz_ranks_set_time_limit(kz_ranks *ranks, double seconds);

/* Between two tiles a stop request is heard. Where that takes more than 6 s, `leave` must end the process; it is called by a
 * signal handler, with "stopped by SIGUSR1" or the like. NULL: no longer. After kz_ranks_set_time_limit. */
void kz_ranks_set_overdue(kz_ranks *ranks, void (*leave)(const char *reason));

/* A checkpoint: one regular locked file; one that another process holds is waited for up to 15 s. `fingerprint` is
 * text (scene, version, numerics: one "name: value" a line) that a resumed run must match; a difference is refused naming
 * the first line that differs. Collective. */
typedef struct {
  const char *path; /* of the checkpoint itself */
  const char *fingerprint;
  bool resume; /* go on from an existing file */
  bool force;  /* discard an existing file */
} kz_checkpoint_plan;
typedef struct kz_checkpoint kz_checkpoint;
/* *checkpoint: NULL where this fails; to be closed. */
kz_status kz_checkpoint_open(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint **checkpoint);
/* Closes and frees it (NULL: KZ_OK); removes the file when `complete`, or where it holds no finished work. Collective. */
kz_status kz_checkpoint_close(kz_ranks *ranks, kz_checkpoint *checkpoint, bool complete);
/* The path of a checkpoint that holds finished work of any rank; NULL where it holds none, or `checkpoint` is NULL. */
const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint);
/* Removes the file of a checkpoint (NULL: none) that holds none. Safe in a signal handler, as kz_checkpoint_saved. */
void kz_checkpoint_forget(const kz_checkpoint *checkpoint);
/* KZ_STOPPED of a stage, once all ranks have agreed on it: adds to the message whether and where the finished work was saved. */
kz_status kz_checkpoint_stopped(const kz_checkpoint *checkpoint);
/* Removes a checkpoint that outlived its complete file: only one that no process holds and that has this fingerprint. */
void kz_checkpoint_clear(const char *path, const char *fingerprint);
/* KZ_REFUSED where the fingerprint `there`, of the file PATH, is not the one `here`: the message has the first line that
 * differs. */
kz_status kz_fingerprint_compare(const char *path, const char *there, const char *here);

/* What stages run on. Without ranks (NULL) everything is done by this process alone, without MPI: collective calls return at once. */
typedef struct {
  kz_ranks *ranks;
  kz_checkpoint *checkpoint; /* of the records of kept stages; NULL: nothing is kept */
} kz_run;

/* Records of varying length that stay with the ranks that made them. */
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

/* Fills record (record_bytes, at most 1 GiB, zeroed before the call) with the result of one tile. No MPI, of kz_ranks only
 * kz_ranks_interrupted. */
typedef kz_status (*kz_tile_fn)(void *context, int64_t tile, void *record);

typedef struct {
  const char *name; /* short, for the progress line and the checkpoint: "table", "cells" */
  int64_t n_tiles;
  size_t record_bytes;
  kz_tile_fn work;
  void *context;
  bool keep; /* records go to the checkpoint as they finish, and are not done again on resume */
  kz_local_records
      *local;      /* not NULL: a record begins with a uint64_t, the bytes that it uses of record_bytes (a multiple of 8); it is
                        added here, on the rank that made it or, from a checkpoint, on any, and `records` is NULL */
  bool everywhere; /* all ranks receive all records; else only rank 0 */
  bool
      collective; /* all ranks do every tile together, in order, each with the same record (everywhere): `work` is collective and may
                      run stages, whose kept records last until its tile is finished */
} kz_stage;

/* Runs a stage; `records` [n_tiles][record_bytes] is filled on the ranks that receive (others may pass NULL unless
 * everywhere). The first failing rank stops the others, and all return its status. Collective. KZ_STOPPED: a signal or the
 * time limit came before the last tile was begun; finished kept records are on disk. Kept stages must come in the same
 * order in every run. `run` NULL, or without ranks: this process alone does all tiles in order and keeps nothing; not for local records. */
kz_status kz_stage_run(const kz_run *run, const kz_stage *stage, void *records);

/* Stages of one tile, each of which needs the one before, show their progress as one, by an estimate of what is left. NULL without ranks. */
typedef struct kz_chain kz_chain;
kz_chain *kz_chain_begin(const kz_run *run, const char *name);
void kz_chain_show(kz_chain *chain, double seconds_left);
void kz_chain_end(kz_chain *chain, bool complete);

/* What all tiles of a stage would take, seconds of processor time, from some that this process does alone and throws away: at most `most`,
 * spread over the stage, and no more of them once they took `enough` seconds. Added to *seconds. Not collective. */
kz_status kz_stage_measure(const kz_stage *stage, int64_t most, double enough, double *seconds);

/* What becomes of local records: each rank makes a message of each of its own, rank 0 takes all messages, in no order. Both may return
 * KZ_FAILED; `make` fills message [message_bytes, at most 1 GiB] and says how many bytes it used, more than 0. */
typedef struct {
  const char *name; /* for the progress line */
  size_t message_bytes;
  kz_status (*make)(void *context, const kz_local_record *piece, void *message, size_t *bytes);
  kz_status (*take)(void *context, const void *message, size_t bytes);
  void *context;
} kz_delivery;
/* Delivers the local records of all ranks. KZ_STOPPED as kz_stage_run. Collective. */
kz_status kz_local_records_deliver(kz_ranks *ranks, const kz_local_records *records, const kz_delivery *delivery);

#endif
