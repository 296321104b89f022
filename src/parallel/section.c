/* Finished records on disk. */
#include "section.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bytes.h"

typedef struct {
  char magic[8];
  char name[32];
  int64_t number; /* of the section in its file */
  int64_t n_tiles;
  uint64_t record_bytes;
  uint64_t checksum; /* of all above, continued from the header's */
} kz_section_head;

typedef struct {
  int64_t tile;
  uint64_t checksum; /* of tile and record, continued from the section's */
} kz_slot_head;

static kz_section_head head_of(const kz_checkpoint *checkpoint, const kz_stage *stage) {
  kz_section_head head = {
      .magic = "kzstage", .number = checkpoint->n_sections, .n_tiles = stage->n_tiles, .record_bytes = stage->record_bytes};
  memcpy(head.name, stage->name, strnlen(stage->name, sizeof head.name - 1));
  head.checksum = kz_bytes_checksum(checkpoint->seed, &head, sizeof head - sizeof head.checksum);
  return head;
}

static uint64_t slot_checksum(const kz_section *section, int64_t tile, const void *record) {
  return kz_bytes_checksum(kz_bytes_checksum(section->seed, &tile, sizeof tile), record, section->record_bytes);
}

/* The space is allocated at once, so that a full disk fails before the work is done. */
static kz_status reserve(const kz_checkpoint *checkpoint, const kz_section *section) {
  int error;
  do error = posix_fallocate(checkpoint->file, (off_t)checkpoint->end, (off_t)(section->end - checkpoint->end));
  while (error == EINTR);
  if (error == 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: no room for %.3g MB: %s", checkpoint->path, 1e-6 * (double)(section->end - checkpoint->end),
                 strerror(error));
}

static bool recall_record(const kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, void *record) {
  const int64_t offset = section->slots + tile * section->stride, n = (int64_t)section->record_bytes;
  kz_slot_head slot;
  if (kz_bytes_read(checkpoint->file, &slot, sizeof slot, offset) != sizeof slot || slot.tile != tile) return false;
  if (kz_bytes_read(checkpoint->file, record, section->record_bytes, offset + (int64_t)sizeof slot) != n) return false;
  return slot_checksum(section, tile, record) == slot.checksum;
}

kz_status kz_section_open(const kz_checkpoint *checkpoint, const kz_stage *stage, char *records, kz_section *section,
                          int64_t **left, int64_t *n_left) {
  const kz_section_head head = head_of(checkpoint, stage);
  kz_section_head found;
  *section = (kz_section){.slots = checkpoint->end + KZ_PAGE, .seed = head.checksum, .record_bytes = stage->record_bytes};
  section->stride = kz_whole_pages((int64_t)(sizeof(kz_slot_head) + stage->record_bytes));
  section->end = section->slots + stage->n_tiles * section->stride;
  const bool known = kz_bytes_read(checkpoint->file, &found, sizeof found, checkpoint->end) == sizeof found &&
                     memcmp(&found, &head, sizeof head) == 0;
  KZ_TRY(reserve(checkpoint, section));
  if (!known && kz_bytes_write(checkpoint->file, &head, sizeof head, checkpoint->end) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  *n_left = 0;
  if (!(*left = malloc((size_t)stage->n_tiles * sizeof **left + 1)))
    return kz_fail(KZ_FAILED, "stage %s: out of memory", stage->name);
  for (int64_t tile = 0; tile < stage->n_tiles; ++tile)
    if (!known || !recall_record(checkpoint, section, tile, records + (size_t)tile * stage->record_bytes))
      (*left)[(*n_left)++] = tile;
  return KZ_OK;
}

void kz_section_adopt(kz_checkpoint *checkpoint, const kz_section *section) {
  checkpoint->end = section->end;
  ++checkpoint->n_sections;
}

/* A write into a removed file would succeed and save nothing. */
static bool is_gone(int file) {
  struct stat facts;
  return fstat(file, &facts) == 0 && facts.st_nlink == 0;
}

kz_status kz_section_save(kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, const void *record) {
  const int64_t offset = section->slots + tile * section->stride;
  const kz_slot_head slot = {.tile = tile, .checksum = slot_checksum(section, tile, record)};
  if (is_gone(checkpoint->file)) return kz_fail(KZ_FAILED, "%s: was removed during the run", checkpoint->path);
  if (kz_bytes_write(checkpoint->file, record, section->record_bytes, offset + (int64_t)sizeof slot) != 0 ||
      kz_bytes_write(checkpoint->file, &slot, sizeof slot, offset) != 0 || kz_header_mark(checkpoint) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  return KZ_OK;
}
