/* A section of the checkpoint: the records of one kept stage. */
#ifndef KAPITZA_PARALLEL_SECTION_H
#define KAPITZA_PARALLEL_SECTION_H

#include "checkpoint.h"
#include "kapitza/parallel.h"

typedef struct {
  int64_t slots;         /* offset of the first slot */
  int64_t stride;        /* bytes of a slot */
  int64_t end;           /* offset behind the last slot */
  uint64_t seed;         /* checksum of the head */
  uint64_t record_bytes; /* at most */
  bool varying;          /* a record begins with its length */
} kz_section;

/* Opens the next section on rank 0: *known = true if it exists already, else it is begun. Space on the disk is reserved for records of fixed
 * length; records of varying length leave holes in the file. */
kz_status kz_section_open(const kz_checkpoint *checkpoint, const kz_stage *stage, kz_section *section, bool *known);
/* Reads the record of a tile in a known section; false if there is no valid one. Any rank. */
bool kz_section_recall(const kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, void *record);
/* Number of bytes in use of a record. */
size_t kz_section_used(const kz_section *section, const void *record);
/* Counts the opened section as part of the checkpoint. Every rank. */
void kz_section_adopt(kz_checkpoint *checkpoint, const kz_section *section);
/* Writes one finished record. Any rank, any time. */
kz_status kz_section_save(kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, const void *record);

#endif
