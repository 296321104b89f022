/* Checks FILE and the files beside it before modelling. These checks leave no file behind. */
#define _GNU_SOURCE /* memmem */
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app.h"

kz_status kz_output_name(const kz_options *options, char *path, size_t bytes) {
  int length;
  if (options->output) {
    length = snprintf(path, bytes, "%s", options->output);
  } else if (strcmp(options->scene, "-") == 0) {
    return kz_fail(KZ_REFUSED, "--output: is missing; a scene from standard input has no name, so give -o FILE");
  } else {
    const char *slash = strrchr(options->scene, '/');
    const char *base = slash ? slash + 1 : options->scene;
    const char *dot = strrchr(base, '.');
    const bool yaml = dot && dot > base && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0);
    length = snprintf(path, bytes, "%.*s.h5", (int)(yaml ? (size_t)(dot - base) : strlen(base)), base);
  }
  if (length >= 0 && (size_t)length < bytes) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%.80s...: the name of the output is too long; use a shorter one", path);
}

static kz_status check_folder(const char *path) {
  char copy[PATH_MAX];
  struct stat facts;
  snprintf(copy, sizeof copy, "%s", path);
  const char *folder = dirname(copy);
  if (stat(folder, &facts) != 0)
    return kz_fail(KZ_REFUSED, "%s: the folder %s cannot be used: %s; name an existing folder", path, folder,
                   strerror(errno));
  if (!S_ISDIR(facts.st_mode)) return kz_fail(KZ_REFUSED, "%s: %s is a file; name an existing folder", path, folder);
  return KZ_OK;
}

static bool is_same_file(const struct stat *file, const char *path) {
  struct stat other;
  return stat(path, &other) == 0 && other.st_dev == file->st_dev && other.st_ino == file->st_ino;
}

/* Whether a file may be replaced: empty, or it begins with the program's words. A link is replaced, not followed. */
static bool is_own(const char *name, const char *words) {
  char bytes[8192];
  FILE *file = fopen(name, "rb");
  const size_t n = file ? fread(bytes, 1, sizeof bytes, file) : 0;
  if (file) fclose(file);
  return n == 0 || memmem(bytes, n, words, strlen(words));
}

/* Refuses FILE or a file beside it if it is not a regular file, or if it is the scene. *exists = true if FILE exists,
 * even as a link to nothing. */
static kz_status check_names(const char *path, const kz_options *options, bool *exists) {
  static const char *const suffixes[] = {".checkpoint", ".part", ".truth", ".truth.part", ""};
  static const char *const words[] = {NULL, KZ_STORE_UNFINISHED, KZ_REFERENCE_WORDS, KZ_REFERENCE_WORDS, NULL};
  for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
    char name[PATH_MAX + 16];
    struct stat file, link;
    snprintf(name, sizeof name, "%s%s", path, suffixes[i]);
    *exists = lstat(name, &link) == 0;
    if (stat(name, &file) == 0) {
      if (!S_ISREG(file.st_mode))
        return kz_fail(KZ_REFUSED, "%s: is %s; give the name of a file", name,
                       S_ISDIR(file.st_mode) ? "a folder" : "not a regular file");
      if (!options->force && words[i] && !S_ISLNK(link.st_mode) && !is_own(name, words[i]))
        return kz_fail(KZ_REFUSED, "%s: exists and would be overwritten; move it away, use --force, or another name",
                       name);
      if (is_same_file(&file, options->scene))
        return kz_fail(KZ_REFUSED, "%s: is the scene itself; use another name", name);
    } else if (errno != ENOENT) {
      return kz_fail(KZ_REFUSED, "%s: cannot be used: %s; use another name", name, strerror(errno));
    }
  }
  return KZ_OK;
}

/* Creates a file in the folder and removes it, which tests permissions, read-only mounts and quotas. */
static kz_status try_folder(const char *path) {
  char name[PATH_MAX + 16];
  snprintf(name, sizeof name, "%s.XXXXXX", path);
  const int file = mkstemp(name);
  if (file < 0)
    return kz_fail(KZ_REFUSED, "%s: cannot be written: %s; use a name in a writable folder", path, strerror(errno));
  close(file);
  unlink(name);
  return KZ_OK;
}

kz_status kz_output_check(const kz_options *options, const char *path, const char *fingerprint, bool *complete) {
  bool exists;
  *complete = false;
  KZ_TRY(check_folder(path));
  KZ_TRY(check_names(path, options, &exists));
  if (!exists) return try_folder(path);
  if (options->force) return try_folder(path);
  if (!options->resume) return kz_fail(KZ_REFUSED, "%s: exists; use --force to overwrite it, or another name", path);
  char *there = kz_store_fingerprint(path);
  const kz_status status =
      there ? kz_fingerprint_compare(path, there, fingerprint)
            : kz_fail(KZ_REFUSED,
                      "%s: exists and is no file of this program; use --force to overwrite it, or another name", path);
  free(there);
  *complete = status == KZ_OK;
  return status;
}
