/* A stop request within a stage of a run with a checkpoint, for LD_PRELOAD: SIGUSR1 comes after KZ_WRITES writes that
 * follow the beginning of a section of the checkpoint, or, with KZ_RESUMED, that of the process. A record takes two
 * writes, the first one of a process one more; 0: before the first tile of the stage. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum { NONE = -1, UNKNOWN = -2 };
static const char SECTION[8] = "kzstage"; /* magic of src/parallel/section.c */

static long stop_at_number(const char *name) {
  const char *text = getenv(name);
  return text ? atol(text) : NONE;
}

ssize_t pwrite(int file, const void *bytes, size_t n, off_t offset) {
  static long left = UNKNOWN;
  ssize_t (*real)(int, const void *, size_t, off_t) =
      (ssize_t (*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  const ssize_t written = real(file, bytes, n, offset);
  if (left == UNKNOWN) left = stop_at_number("KZ_RESUMED") > 0 ? stop_at_number("KZ_WRITES") : NONE;
  if (n >= sizeof SECTION && memcmp(bytes, SECTION, sizeof SECTION) == 0)
    left = stop_at_number("KZ_WRITES");
  else if (left > 0)
    left--;
  else
    return written;
  if (left == 0) raise(SIGUSR1);
  return written;
}
