/* The checkpoint, which all ranks open and close together. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checkpoint.h"
#include "ranks.h"

const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint) {
  return checkpoint && checkpoint->ours && kz_header_is_marked(checkpoint) ? checkpoint->path : NULL;
}

void kz_checkpoint_forget(const kz_checkpoint *checkpoint) {
  if (checkpoint && checkpoint->ours && !kz_header_is_marked(checkpoint) &&
      kz_file_lock_names(checkpoint->path, checkpoint->file))
    unlink(checkpoint->path);
}

kz_status kz_checkpoint_stopped(const kz_checkpoint *checkpoint) {
  char reason[KZ_MESSAGE_BYTES];
  const char *saved = kz_checkpoint_saved(checkpoint);
  snprintf(reason, sizeof reason, "%s", kz_message());
  kz_message_clear();
  if (!saved) return kz_fail(KZ_STOPPED, "%s; nothing was saved", reason);
  return kz_fail(KZ_STOPPED, "%s; finished work is in %s; --resume goes on from it", reason, saved);
}

/* Rank 0 decides whether the file is gone on from or begun anew. */
static kz_status begin(kz_checkpoint *checkpoint, const kz_checkpoint_plan *plan) {
  kz_file_lock file_lock = {.file = -1};
  KZ_TRY(kz_file_lock_take(plan->path, plan->resume || plan->force, &file_lock));
  checkpoint->file = file_lock.file;
  bool anew = !file_lock.existed || plan->force;
  if (!anew) KZ_TRY(kz_header_read(checkpoint, plan->fingerprint, &anew));
  if (anew) KZ_TRY(kz_header_write(checkpoint, plan->fingerprint));
  return kz_file_lock_share(plan->path, file_lock.file);
}

/* A file that holds no work of this run or an earlier one is not left behind. Closing the file gives its locks back. */
static void release(kz_checkpoint *checkpoint, int rank) {
  if (checkpoint->file >= 0) {
    if (rank == 0) kz_checkpoint_forget(checkpoint);
    close(checkpoint->file);
  }
  free(checkpoint->path);
  free(checkpoint);
}

static kz_status open_together(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint *checkpoint) {
  KZ_TRY(kz_ranks_agree(ranks, ranks->rank == 0 ? begin(checkpoint, plan) : KZ_OK));
  KZ_TRY(kz_ranks_agree(ranks, ranks->rank != 0 ? kz_file_lock_join(plan->path, &checkpoint->file) : KZ_OK));
  return kz_ranks_broadcast(ranks, &checkpoint->ours, sizeof checkpoint->ours);
}

kz_status kz_checkpoint_open(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint **checkpoint) {
  kz_checkpoint *opened = kz_malloc(sizeof *opened);
  *opened = (kz_checkpoint){.file = -1, .path = kz_strdup(plan->path)};
  const kz_status status = open_together(ranks, plan, opened);
  *checkpoint = status == KZ_OK ? opened : NULL;
  if (status != KZ_OK) release(opened, ranks->rank);
  return status;
}

void kz_checkpoint_clear(const char *path, const char *fingerprint) {
  kz_checkpoint checkpoint = {.file = -1, .path = (char *)path};
  bool unfinished;
  if (!kz_file_lock_try(path, &checkpoint.file)) return;
  if (kz_header_read(&checkpoint, fingerprint, &unfinished) == KZ_OK && !unfinished) unlink(path);
  kz_message_clear();
  close(checkpoint.file);
}

static kz_status remove_file(const kz_checkpoint *checkpoint) {
  if (unlink(checkpoint->path) == 0 || errno == ENOENT) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: cannot be removed: %s", checkpoint->path, strerror(errno));
}

static kz_status keep_file(const kz_checkpoint *checkpoint) {
  if (!kz_file_lock_names(checkpoint->path, checkpoint->file))
    return kz_fail(KZ_FAILED, "%s: was removed during the run; finished work is lost", checkpoint->path);
  if (fsync(checkpoint->file) == 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: cannot be saved: %s", checkpoint->path, strerror(errno));
}

kz_status kz_checkpoint_close(kz_ranks *ranks, kz_checkpoint *checkpoint, bool complete) {
  if (!checkpoint) return KZ_OK;
  kz_status status = KZ_OK;
  if (complete) {
    if (ranks->rank == 0) status = remove_file(checkpoint);
  } else if (kz_checkpoint_saved(checkpoint))
    status = keep_file(checkpoint);
  status = kz_ranks_agree(ranks, status);
  release(checkpoint, ranks->rank);
  return status;
}
