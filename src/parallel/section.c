/* Finished records on disk. */
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>

#include "bytes.h"
#include "checkpoint.h"

typedef struct {
  char magic[8];
  char name[32];
  int64_t number; /* Number of the section in its file */
  int64_t n_tiles;
  uint64_t record_bytes;
  uint64_t checksum; /* Checksum of the fields above, continued from the header's */
} kz_section_head;

typedef struct {
  int64_t tile;
  uint64_t checksum; /* Checksum of tile and record, continued from the section's */
} kz_slot_head;

static kz_section_head head_of(const kz_checkpoint *checkpoint, const kz_stage *stage) {
  kz_section_head head = {.magic = "kzstage",
                          .number = checkpoint->n_sections,
                          .n_tiles = stage->n_tiles,
                          .record_bytes = stage->record_bytes};
  memcpy(head.name, stage->name, strnlen(stage->name, sizeof head.name - 1));
  head.checksum = kz_bytes_checksum(checkpoint->seed, &head, sizeof head - sizeof head.checksum);
  return head;
}

size_t kz_section_used(const kz_section *section, const void *record) {
  uint64_t bytes = section->record_bytes;
  if (section->varying) memcpy(&bytes, record, sizeof bytes);
  return bytes;
}

static uint64_t slot_checksum(const kz_section *section, int64_t tile, const void *record) {
  return kz_bytes_checksum(kz_bytes_checksum(section->seed, &tile, sizeof tile), record,
                           kz_section_used(section, record));
}

/* Allocates the space at once, so that a full disk fails before the work is done. */
static kz_status reserve_space(const kz_checkpoint *checkpoint, const kz_section *section) {
  int error;
  do error = posix_fallocate(checkpoint->file, (off_t)checkpoint->end, (off_t)(section->end - checkpoint->end));
  while (error == EINTR);
  if (error == 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: no space for %.3g MB: %s", checkpoint->path,
                 1e-6 * (double)(section->end - checkpoint->end), strerror(error));
}

bool kz_section_recall(const kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, void *record) {
  const int64_t offset = section->slots + tile * section->stride, begin = offset + (int64_t)sizeof(kz_slot_head);
  kz_slot_head slot;
  uint64_t used = section->record_bytes;
  if (kz_bytes_read(checkpoint->file, &slot, sizeof slot, offset) != sizeof slot || slot.tile != tile) return false;
  if (section->varying && kz_bytes_read(checkpoint->file, &used, sizeof used, begin) != sizeof used) return false;
  if (used > section->record_bytes || (section->varying && used < sizeof used)) return false;
  if (kz_bytes_read(checkpoint->file, record, used, begin) != (int64_t)used) return false;
  return slot_checksum(section, tile, record) == slot.checksum;
}

kz_status kz_section_open(const kz_checkpoint *checkpoint, const kz_stage *stage, kz_section *section, bool *known) {
  const kz_section_head head = head_of(checkpoint, stage);
  kz_section_head found;
  *section = (kz_section){.slots = checkpoint->end + KZ_PAGE,
                          .seed = head.checksum,
                          .record_bytes = stage->record_bytes,
                          .varying = stage->local != NULL};
  section->stride = kz_whole_pages((int64_t)(sizeof(kz_slot_head) + stage->record_bytes));
  section->end = section->slots + stage->n_tiles * section->stride;
  *known = kz_bytes_read(checkpoint->file, &found, sizeof found, checkpoint->end) == sizeof found &&
           memcmp(&found, &head, sizeof head) == 0;
  if (!section->varying) KZ_TRY(reserve_space(checkpoint, section));
  if (!*known && kz_bytes_write(checkpoint->file, &head, sizeof head, checkpoint->end) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  return KZ_OK;
}

void kz_section_adopt(kz_checkpoint *checkpoint, const kz_section *section) {
  checkpoint->end = section->end;
  ++checkpoint->n_sections;
}

/* True if the file was removed: writing into it would succeed and save nothing. */
static bool is_gone(int file) {
  struct stat facts;
  return fstat(file, &facts) == 0 && facts.st_nlink == 0;
}

kz_status kz_section_save(kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, const void *record) {
  const int64_t offset = section->slots + tile * section->stride;
  const kz_slot_head slot = {.tile = tile, .checksum = slot_checksum(section, tile, record)};
  if (is_gone(checkpoint->file)) return kz_fail(KZ_FAILED, "%s: was removed during the run", checkpoint->path);
  if (kz_bytes_write(checkpoint->file, record, kz_section_used(section, record), offset + (int64_t)sizeof slot) != 0 ||
      kz_bytes_write(checkpoint->file, &slot, sizeof slot, offset) != 0 || kz_header_mark(checkpoint) != 0)
    return kz_fail(KZ_FAILED, "%s: cannot be written: %s", checkpoint->path, strerror(errno));
  return KZ_OK;
}
