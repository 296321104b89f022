/* The checkpoint: one regular, locked file of finished records.
 *
 *   header            magic, format, fingerprint, checksum, whether any record follows; whole pages
 *   section, one per kept stage in the order of the run:
 *     head            name, tiles, bytes of a record, checksum; one page
 *     slot per tile   tile number, checksum, record; whole pages, so that two writers never share one
 *
 * Every checksum is continued from that of the part above it: a slot counts only in its own section of its own run. */
#pragma once

#include "kapitza/parallel.h"

struct kz_checkpoint {
  int file; /* Open file; -1: none */
  char *path;
  bool ours;     /* True: begun by a run with this fingerprint */
  bool marked;   /* True: this rank has marked in the header that there are records */
  uint64_t seed; /* checksum of the header */
  int64_t end;   /* offset of the next section */
  int64_t n_sections;
};

enum { KZ_PAGE = 4096 };
static inline int64_t kz_whole_pages(int64_t bytes) {
  return (bytes + KZ_PAGE - 1) / KZ_PAGE * KZ_PAGE;
}

/* Opens or creates the file at `path` for rank 0, locks it against every other run, and waits for ranks of an earlier
 * run that are still writing. `existed`: it was there. */
typedef struct kz_file_lock {
  int file;
  bool existed;
} kz_file_lock;
kz_status kz_file_lock_take(const char *path, bool may_exist, kz_file_lock *file_lock);
/* Locks an existing file without waiting; false if it does not exist, or if another process has locked it. */
bool kz_file_lock_try(const char *path, int *file);
/* Lets the other ranks of this run join. */
kz_status kz_file_lock_share(const char *path, int file);
/* Joins as another rank of this run. */
kz_status kz_file_lock_join(const char *path, int *file);
/* True if `path` still names the open file. */
bool kz_file_lock_names(const char *path, int file);
/* Marks in the header that the file has a finished record. Any rank. Returns 0, or -1 with errno. */
int kz_header_mark(kz_checkpoint *checkpoint);

/* A section: the records of one kept stage. */
typedef struct {
  int64_t slots;         /* offset of the first slot */
  int64_t stride;        /* bytes of a slot */
  int64_t end;           /* offset behind the last slot */
  uint64_t seed;         /* checksum of the head */
  uint64_t record_bytes; /* Largest size of a record */
  bool varying;          /* a record begins with its length */
} kz_section;

/* Opens the next section on rank 0: *known = true if it exists already, else it is begun. Space on the disk is reserved
 * for records of fixed length; records of varying length leave holes in the file. */
kz_status kz_section_open(const kz_checkpoint *checkpoint, const kz_stage *stage, kz_section *section, bool *known);
/* Reads the record of a tile in a known section; false if there is no valid one. Any rank. */
bool kz_section_recall(const kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, void *record);
/* Number of bytes in use of a record. */
size_t kz_section_used(const kz_section *section, const void *record);
/* Counts the opened section as part of the checkpoint. Every rank. */
void kz_section_adopt(kz_checkpoint *checkpoint, const kz_section *section);
/* Writes one finished record. Any rank, any time. */
kz_status kz_section_save(kz_checkpoint *checkpoint, const kz_section *section, int64_t tile, const void *record);
