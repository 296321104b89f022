/* Locks of the checkpoint file. They belong to the open file, so they end with the process whatever kills it.
 *
 * Byte 0 is locked by rank 0, byte 1 is shared by all ranks of the run. A new run must get both alone. */
#define _GNU_SOURCE /* locks of an open file, not of a process */
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "checkpoint.h"
#include "ranks.h"

static const double WAIT_SECONDS = 15.0; /* s: ranks outlive a killed mpirun by a few seconds */
static const struct timespec RETRY_PAUSE = {.tv_nsec = 100000000};

enum { OWNER = 0, MEMBERS = 1 };

static int lock_bytes(int file, short type, off_t first, off_t n) {
  struct flock range = {.l_type = type, .l_whence = SEEK_SET, .l_start = first, .l_len = n};
  return fcntl(file, F_OFD_SETLK, &range);
}

static bool is_held(int error) {
  return error == EAGAIN || error == EACCES;
}

bool kz_file_lock_names(const char *path, int file) {
  struct stat named, opened;
  return lstat(path, &named) == 0 && fstat(file, &opened) == 0 && named.st_dev == opened.st_dev &&
         named.st_ino == opened.st_ino;
}

/* Opens or creates the file; KZ_OK with file < 0 if another process created it meanwhile. Links are refused, since they
 * may lead anywhere. */
static kz_status open_or_create(const char *path, kz_file_lock *file_lock) {
  file_lock->existed = true;
  file_lock->file = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (file_lock->file < 0 && errno == ENOENT) {
    file_lock->existed = false;
    file_lock->file = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_lock->file < 0 && errno == EEXIST) return KZ_OK;
  }
  struct stat facts;
  if (file_lock->file >= 0 && fstat(file_lock->file, &facts) == 0 && S_ISREG(facts.st_mode)) return KZ_OK;
  const char *reason = file_lock->file >= 0 ? "not a regular file" : errno == ELOOP ? "a link" : strerror(errno);
  if (file_lock->file >= 0) close(file_lock->file);
  file_lock->file = -1;
  return kz_fail(KZ_REFUSED,
                 "%s: cannot be used as checkpoint: %s; move it away, or give the result another name with -o", path,
                 reason);
}

/* Tries once to lock the file; KZ_OK with file < 0 if another process holds it, or if it was replaced meanwhile. */
static kz_status try_to_lock(const char *path, bool may_exist, kz_file_lock *file_lock) {
  KZ_TRY(open_or_create(path, file_lock));
  if (file_lock->file < 0) return KZ_OK;
  kz_status status = KZ_OK;
  if (file_lock->existed && !may_exist)
    status =
        lock_bytes(file_lock->file, F_WRLCK, OWNER, 2) != 0 && is_held(errno)
            ? kz_fail(KZ_REFUSED,
                      "%s: another run works on this result; wait until it has ended, or give another name with -o",
                      path)
            : kz_fail(
                  KZ_REFUSED,
                  "%s: a checkpoint of an earlier run exists; use --resume to go on from it, or --force to discard it",
                  path);
  else if (lock_bytes(file_lock->file, F_WRLCK, OWNER, 2) == 0 && kz_file_lock_names(path, file_lock->file))
    return KZ_OK;
  else if (!is_held(errno) && kz_file_lock_names(path, file_lock->file)) {
    status = kz_fail(KZ_REFUSED, "%s: cannot be locked: %s", path, strerror(errno));
    if (!file_lock->existed) unlink(path); /* else this empty file would stop the next run */
  }
  close(file_lock->file);
  file_lock->file = -1;
  return status;
}

kz_status kz_file_lock_take(const char *path, bool may_exist, kz_file_lock *file_lock) {
  for (const double begun = kz_clock(); kz_clock() - begun < WAIT_SECONDS; nanosleep(&RETRY_PAUSE, NULL)) {
    KZ_TRY(try_to_lock(path, may_exist, file_lock));
    if (file_lock->file >= 0) return KZ_OK;
    if (kz_signals_caught()) return kz_fail(KZ_STOPPED, "%s: stopped while it was held by another process", path);
  }
  return kz_fail(KZ_REFUSED, "%s: is held by another process; wait until that run has ended", path);
}

bool kz_file_lock_try(const char *path, int *file) {
  *file = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (*file < 0) return false;
  if (lock_bytes(*file, F_WRLCK, OWNER, 2) == 0 && kz_file_lock_names(path, *file)) return true;
  close(*file);
  *file = -1;
  return false;
}

kz_status kz_file_lock_share(const char *path, int file) {
  if (lock_bytes(file, F_RDLCK, MEMBERS, 1) == 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "%s: cannot be shared: %s", path, strerror(errno));
}

kz_status kz_file_lock_join(const char *path, int *file) {
  *file = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (*file >= 0 && lock_bytes(*file, F_RDLCK, MEMBERS, 1) == 0) return KZ_OK;
  const int error = errno;
  if (*file >= 0) close(*file);
  *file = -1;
  return kz_fail(KZ_REFUSED,
                 "%s: cannot be opened by every rank: %s; use a folder that all ranks see under the same name", path,
                 strerror(error));
}
