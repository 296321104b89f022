/* The header of the checkpoint: whose run it is. */
#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bytes.h"
#include "checkpoint.h"

enum { FORMAT = 2 };
static const int64_t TEXT_MAX = (int64_t)1 << 28;

typedef struct {
  char magic[8]; /* written last: without it nothing counts */
  int64_t format;
  int64_t text_bytes; /* of the fingerprint that follows */
  uint64_t checksum;  /* of format, text_bytes and the text */
  int64_t marked;     /* 1 once a finished record follows */
} kz_header;

static const char MAGIC[8] = "kzcheck";

static uint64_t checksum(const kz_header *header, const char *text) {
  const uint64_t sum = kz_bytes_checksum(0, &header->format, offsetof(kz_header, checksum) - offsetof(kz_header, format));
  return kz_bytes_checksum(sum, text, (size_t)header->text_bytes);
}

static void adopt(kz_checkpoint *checkpoint, const kz_header *header) {
  checkpoint->ours = true;
  checkpoint->seed = header->checksum;
  checkpoint->end = kz_whole_pages((int64_t)sizeof *header + header->text_bytes);
}

kz_status kz_header_write(kz_checkpoint *checkpoint, const char *fingerprint) {
  kz_header header = {.format = FORMAT, .text_bytes = (int64_t)strlen(fingerprint)};
  header.checksum = checksum(&header, fingerprint);
  adopt(checkpoint, &header);
  const int file = checkpoint->file;
  if (ftruncate(file, 0) != 0 || kz_bytes_write(file, fingerprint, (size_t)header.text_bytes, sizeof header) != 0 ||
      kz_bytes_write(file, &header, sizeof header, 0) != 0 || kz_bytes_write(file, MAGIC, sizeof MAGIC, 0) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  return KZ_OK;
}

static kz_status damaged(const kz_checkpoint *checkpoint) {
  return kz_fail(KZ_REFUSED, "%s: is damaged or no checkpoint of this program; use --force to discard it", checkpoint->path);
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
  return kz_fail(KZ_REFUSED, "%s: belongs to another run: it has \"%.*s\", this run has \"%.*s\"; use --force to discard it",
                 path, n_there > 0 ? n_there : 7, n_there > 0 ? there : "nothing", n_here > 0 ? n_here : 7,
                 n_here > 0 ? here : "nothing");
}

static kz_status read_text(kz_checkpoint *checkpoint, const kz_header *header, const char *fingerprint, char *text) {
  const int64_t n = header->text_bytes;
  if (kz_bytes_read(checkpoint->file, text, (size_t)n, sizeof *header) != n || checksum(header, text) != header->checksum)
    return damaged(checkpoint);
  text[n] = '\0';
  KZ_TRY(kz_fingerprint_compare(checkpoint->path, text, fingerprint));
  adopt(checkpoint, header);
  return KZ_OK;
}

int kz_header_mark(kz_checkpoint *checkpoint) {
  const int64_t marked = 1;
  if (checkpoint->marked) return 0;
  checkpoint->marked = kz_bytes_write(checkpoint->file, &marked, sizeof marked, offsetof(kz_header, marked)) == 0;
  return checkpoint->marked ? 0 : -1;
}

bool kz_header_is_marked(const kz_checkpoint *checkpoint) {
  int64_t marked;
  return kz_bytes_read(checkpoint->file, &marked, sizeof marked, offsetof(kz_header, marked)) == sizeof marked && marked == 1;
}

kz_status kz_header_read(kz_checkpoint *checkpoint, const char *fingerprint, bool *unfinished) {
  kz_header header = {.magic = ""};
  const int64_t n = kz_bytes_read(checkpoint->file, &header, sizeof header, 0);
  if (n < 0) return kz_fail(KZ_REFUSED, "%s: cannot be read: %s", checkpoint->path, strerror(errno));
  *unfinished = memcmp(header.magic, (char[sizeof MAGIC]){0}, sizeof MAGIC) == 0;
  if (*unfinished) return KZ_OK;
  if (n < (int64_t)sizeof header || memcmp(header.magic, MAGIC, sizeof MAGIC) != 0 || header.format != FORMAT ||
      header.text_bytes < 0 || header.text_bytes > TEXT_MAX)
    return damaged(checkpoint);
  char *text = kz_malloc((size_t)header.text_bytes + 1);
  const kz_status status = read_text(checkpoint, &header, fingerprint, text);
  free(text);
  return status;
}
