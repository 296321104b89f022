/* A section of the checkpoint: the records of one kept stage. */
#ifndef KAPITZA_PARALLEL_SECTION_H
#define KAPITZA_PARALLEL_SECTION_H

#include "checkpoint.h"
#include "kapitza/parallel.h"

typedef struct {
  int64_t slots;  /* offset of the first slot */
  int64_t stride; /* bytes of a slot */
  int64_t end;    /* offset behind the last slot */
  uint64_t seed;  /* checksum of the head */
  uint64_t record_bytes;
} kz_section;

/* Opens the next section on rank 0: finds or begins it, and reserves its room on the disk. Valid records found there are
 * read into `records`; `left` [n_left] are the other tiles, to be freed by the caller. */
kz_status kz_section_open(const kz_checkpoint *checkpoint, const kz_stage *stage, char *records, kz_section *section,
                          int64_t **left, int64_t *n_left);
/* Counts the opened section as part of the checkpoint. Every rank. */
void kz_section_adopt(kz_checkpoint *checkpoint, const kz_section *section);
/* Writes one finished record. Any rank, any time. */
kz_status kz_section_save(kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, const void *record);

#endif
