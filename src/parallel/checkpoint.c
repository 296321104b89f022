/* The checkpoint, which all ranks open and close together. */
#include <errno.h>
#include <unistd.h>

#include "checkpoint.h"
#include "ranks.h"
#include "bytes.h"

/* ---- the header: whose run it is ---- */

enum { FORMAT_VERSION = 2 };
static const int64_t TEXT_MAX = (int64_t)1 << 28;

typedef struct {
  char magic[8]; /* Written last: without it nothing counts */
  int64_t format;
  int64_t text_bytes; /* Bytes of the fingerprint that follows */
  uint64_t checksum;  /* Checksum of format, text_bytes and the text */
  int64_t marked;     /* 1 once a finished record follows */
} kz_header;

static const char MAGIC[8] = "kzcheck";

static uint64_t header_checksum(const kz_header *header, const char *text) {
  const uint64_t sum =
      kz_bytes_checksum(0, &header->format, offsetof(kz_header, checksum) - offsetof(kz_header, format));
  return kz_bytes_checksum(sum, text, (size_t)header->text_bytes);
}

static void adopt_header(kz_checkpoint *checkpoint, const kz_header *header) {
  checkpoint->ours = true;
  checkpoint->seed = header->checksum;
  checkpoint->end = kz_whole_pages((int64_t)sizeof *header + header->text_bytes);
}

/* Writes the header of a run with this fingerprint. */
static kz_status write_header(kz_checkpoint *checkpoint, const char *fingerprint) {
  kz_header header = {.format = FORMAT_VERSION, .text_bytes = (int64_t)strlen(fingerprint)};
  header.checksum = header_checksum(&header, fingerprint);
  adopt_header(checkpoint, &header);
  const int file = checkpoint->file;
  if (ftruncate(file, 0) != 0 || kz_bytes_write(file, fingerprint, (size_t)header.text_bytes, sizeof header) != 0 ||
      kz_bytes_write(file, &header, sizeof header, 0) != 0 || kz_bytes_write(file, MAGIC, sizeof MAGIC, 0) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  return KZ_OK;
}

static kz_status refuse_damaged(const kz_checkpoint *checkpoint) {
  return kz_fail(KZ_REFUSED, "%s: is damaged or no checkpoint of this program; use --force to discard it",
                 checkpoint->path);
}

kz_status kz_fingerprint_compare(const char *path, const char *there, const char *here) {
  while (*there && *there == *here) {
    const size_t n = strcspn(there, "\n");
    if (n != strcspn(here, "\n") || strncmp(there, here, n) != 0) break;
    there += n + (there[n] == '\n');
    here += n + (here[n] == '\n');
  }
  if (*there == *here && *there == '\0') return KZ_OK;
  const int n_there = (int)strcspn(there, "\n"), n_here = (int)strcspn(here, "\n");
  return kz_fail(KZ_REFUSED,
                 "%s: belongs to another run: it has \"%.*s\", this run has \"%.*s\"; use --force to discard it", path,
                 n_there > 0 ? n_there : 7, n_there > 0 ? there : "nothing", n_here > 0 ? n_here : 7,
                 n_here > 0 ? here : "nothing");
}

static kz_status read_text(kz_checkpoint *checkpoint, const kz_header *header, const char *fingerprint, char *text) {
  const int64_t n = header->text_bytes;
  if (kz_bytes_read(checkpoint->file, text, (size_t)n, sizeof *header) != n ||
      header_checksum(header, text) != header->checksum)
    return refuse_damaged(checkpoint);
  text[n] = '\0';
  KZ_TRY(kz_fingerprint_compare(checkpoint->path, text, fingerprint));
  adopt_header(checkpoint, header);
  return KZ_OK;
}

int kz_header_mark(kz_checkpoint *checkpoint) {
  const int64_t marked = 1;
  if (checkpoint->marked) return 0;
  checkpoint->marked = kz_bytes_write(checkpoint->file, &marked, sizeof marked, offsetof(kz_header, marked)) == 0;
  return checkpoint->marked ? 0 : -1;
}

/* True if the header has this mark. */
static bool header_is_marked(const kz_checkpoint *checkpoint) {
  int64_t marked;
  return kz_bytes_read(checkpoint->file, &marked, sizeof marked, offsetof(kz_header, marked)) == sizeof marked &&
         marked == 1;
}

/* Reads and checks the header. *unfinished = true if the run that created the file ended before it had written the
 * header. KZ_REFUSED if the header is damaged or has another fingerprint. */
static kz_status read_header(kz_checkpoint *checkpoint, const char *fingerprint, bool *unfinished) {
  kz_header header = {.magic = ""};
  const int64_t n = kz_bytes_read(checkpoint->file, &header, sizeof header, 0);
  if (n < 0) return kz_fail(KZ_REFUSED, "%s: cannot be read: %s", checkpoint->path, strerror(errno));
  *unfinished = memcmp(header.magic, (char[sizeof MAGIC]){0}, sizeof MAGIC) == 0;
  if (*unfinished) return KZ_OK;
  if (n < (int64_t)sizeof header || memcmp(header.magic, MAGIC, sizeof MAGIC) != 0 || header.format != FORMAT_VERSION ||
      header.text_bytes < 0 || header.text_bytes > TEXT_MAX)
    return refuse_damaged(checkpoint);
  char *text = kz_malloc((size_t)header.text_bytes + 1);
  const kz_status status = read_text(checkpoint, &header, fingerprint, text);
  free(text);
  return status;
}

const char *kz_checkpoint_saved(const kz_checkpoint *checkpoint) {
  return checkpoint && checkpoint->ours && header_is_marked(checkpoint) ? checkpoint->path : NULL;
}

void kz_checkpoint_forget(const kz_checkpoint *checkpoint) {
  if (checkpoint && checkpoint->ours && !header_is_marked(checkpoint) &&
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

/* Rank 0: resumes the file or begins it anew. */
static kz_status begin_file(kz_checkpoint *checkpoint, const kz_checkpoint_plan *plan) {
  kz_file_lock file_lock = {.file = -1};
  KZ_TRY(kz_file_lock_take(plan->path, plan->resume || plan->force, &file_lock));
  checkpoint->file = file_lock.file;
  bool anew = !file_lock.existed || plan->force;
  if (!anew) KZ_TRY(read_header(checkpoint, plan->fingerprint, &anew));
  if (anew) KZ_TRY(write_header(checkpoint, plan->fingerprint));
  return kz_file_lock_share(plan->path, file_lock.file);
}

/* Closes the file, which releases its locks, and removes it if it has no finished work. */
static void release_checkpoint(kz_checkpoint *checkpoint, int rank) {
  if (checkpoint->file >= 0) {
    if (rank == 0) kz_checkpoint_forget(checkpoint);
    close(checkpoint->file);
  }
  free(checkpoint->path);
  free(checkpoint);
}

static kz_status open_together(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint *checkpoint) {
  KZ_TRY(kz_ranks_agree(ranks, ranks->rank == 0 ? begin_file(checkpoint, plan) : KZ_OK));
  KZ_TRY(kz_ranks_agree(ranks, ranks->rank != 0 ? kz_file_lock_join(plan->path, &checkpoint->file) : KZ_OK));
  return kz_ranks_broadcast(ranks, &checkpoint->ours, sizeof checkpoint->ours);
}

kz_status kz_checkpoint_open(kz_ranks *ranks, const kz_checkpoint_plan *plan, kz_checkpoint **checkpoint) {
  kz_checkpoint *opened = kz_malloc(sizeof *opened);
  *opened = (kz_checkpoint){.file = -1, .path = kz_strdup(plan->path)};
  const kz_status status = open_together(ranks, plan, opened);
  *checkpoint = status == KZ_OK ? opened : NULL;
  if (status != KZ_OK) release_checkpoint(opened, ranks->rank);
  return status;
}

void kz_checkpoint_clear(const char *path, const char *fingerprint) {
  kz_checkpoint checkpoint = {.file = -1, .path = (char *)path};
  bool unfinished;
  if (!kz_file_lock_try(path, &checkpoint.file)) return;
  if (read_header(&checkpoint, fingerprint, &unfinished) == KZ_OK && !unfinished) unlink(path);
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
  release_checkpoint(checkpoint, ranks->rank);
  return status;
}
