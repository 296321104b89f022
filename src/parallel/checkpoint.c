/* The checkpoint as one rank has opened it. */
#include "checkpoint.h"

#include <stdio.h>
#include <unistd.h>

enum { MESSAGE_BYTES = 2048 };

const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint) {
  return checkpoint && checkpoint->ours && kz_header_is_marked(checkpoint) ? checkpoint->path : NULL;
}

void kz_checkpoint_forget(const kz_checkpoint *checkpoint) {
  if (checkpoint && checkpoint->ours && !kz_header_is_marked(checkpoint) &&
      kz_file_lock_names(checkpoint->path, checkpoint->file))
    unlink(checkpoint->path);
}

kz_status kz_checkpoint_stopped(const kz_checkpoint *checkpoint) {
  char reason[MESSAGE_BYTES];
  const char *saved = kz_checkpoint_saved(checkpoint);
  snprintf(reason, sizeof reason, "%s", kz_message());
  kz_message_clear();
  return kz_fail(KZ_STOPPED, "%s; %s%s", reason, saved ? "finished work is in " : "nothing was saved", saved ? saved : "");
}
