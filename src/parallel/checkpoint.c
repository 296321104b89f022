/* What one rank does with the file of a checkpoint. */
#include "checkpoint.h"

#include <stdlib.h>
#include <unistd.h>

void kz_checkpoint_release(kz_checkpoint *checkpoint) {
  if (checkpoint->file >= 0) close(checkpoint->file);
  free(checkpoint->path);
  *checkpoint = (kz_checkpoint){.file = -1};
}

bool kz_checkpoint_holds_work(const kz_checkpoint *checkpoint) {
  return checkpoint->file >= 0 && checkpoint->ours && kz_header_is_marked(checkpoint);
}

void kz_checkpoint_forget(const kz_checkpoint *checkpoint) {
  if (checkpoint->file >= 0 && checkpoint->ours && !kz_header_is_marked(checkpoint) &&
      kz_file_lock_names(checkpoint->path, checkpoint->file))
    unlink(checkpoint->path);
}
