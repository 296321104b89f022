/* Runs of scenes, and atlases of result files, in the process of the caller. HDF5 serves one thread at a time. */
#include <errno.h>
#include <sys/stat.h>

#include "../library.h"

static pthread_mutex_t one_thread = PTHREAD_MUTEX_INITIALIZER;

typedef struct {
  const char *scene, *output;
  bool overwrite;
  char **summary;
  kz_store *store;
} job;

static kz_status run_scene(void *context) {
  job *j = context;
  char *words = NULL;
  const kz_status status = kz_run_text(j->scene, j->output, j->overwrite, &words, &j->store);
  if (status == KZ_OK && j->summary) {
    *j->summary = kz_border_give(strlen(words) + 1);
    strcpy(*j->summary, words);
  }
  free(words);
  return status;
}

static kz_status run_discard(void *context) {
  kz_store_discard(context);
  return KZ_OK;
}

kapitza_status kz_library_run(const char *scene, const char *output, int32_t overwrite, char **summary) {
  job j = {.scene = scene, .output = output, .overwrite = overwrite != 0, .summary = summary};
  bool left, again;
  if (summary) *summary = NULL;
  kz_message_clear();
  if (kz_tables_make() != KZ_OK) return KAPITZA_NO_MEMORY;
  kz_border *border = kz_border_create();
  if (!border) {
    kz_fail(KZ_FAILED, "memory ran out");
    return KAPITZA_NO_MEMORY;
  }
  pthread_mutex_lock(&one_thread);
  const kz_status status = kz_border_call(border, kz_library_pause(), NULL, run_scene, &j, &left);
  const kapitza_status told = kz_library_status(status, border);
  if (left && j.store) kz_border_call(border, NULL, NULL, run_discard, j.store, &again);
  pthread_mutex_unlock(&one_thread);
  kz_border_free(border);
  return told;
}

/* ---- atlases ---- */

kz_status kz_library_store_work(kz_status (*work)(void *context), void *context, kz_store **store) {
  *store = NULL;
  pthread_mutex_lock(&one_thread);
  const kz_status status = kz_border_guard(work, context);
  if (*store) kz_store_discard(*store);
  pthread_mutex_unlock(&one_thread);
  kz_border_leave();
  return status;
}

struct kz_library_atlas {
  char *path;
  struct timespec changed;
  kz_scene scene; /* scene of the file */
  kz_atlas *atlas;
  kz_store *store; /* while it is read */
};

static kz_status atlas_read(void *context) {
  kz_library_atlas *own = context;
  KZ_TRY(kz_store_open(own->path, &own->store));
  KZ_AUTOFREE char *text = kz_store_text_of(own->store, "scene_resolved");
  if (!text) return kz_fail(KZ_REFUSED, "%s: has no scene", own->path);
  KZ_TRY(kz_scene_read(text, strlen(text), own->path, 0, NULL, &own->scene));
  return kz_atlas_open(&own->scene, own->store, &own->atlas);
}

static void atlas_free(kz_library_atlas *own) {
  if (!own) return;
  kz_atlas_close(own->atlas);
  kz_scene_free(&own->scene);
  free(own->path);
  free(own);
}

kz_status kz_library_atlas_of(kapitza_pendulum *p, const char *path, kz_atlas **atlas) {
  struct stat now;
  if (stat(path, &now) != 0) return kz_fail(KZ_REFUSED, "atlas: %s: cannot be opened: %s", path, strerror(errno));
  if (!S_ISREG(now.st_mode)) return kz_fail(KZ_REFUSED, "atlas: %s: is not a regular file", path);
  const kz_library_atlas *kept = p->atlas;
  if (!kept || strcmp(kept->path, path) != 0 || memcmp(&kept->changed, &now.st_mtim, sizeof now.st_mtim) != 0) {
    atlas_free(p->atlas);
    p->atlas = NULL;
    kz_library_atlas *own = kz_calloc(1, sizeof *own);
    own->path = kz_strdup(path);
    own->changed = now.st_mtim;
    const kz_status status = kz_library_store_work(atlas_read, own, &own->store);
    if (status != KZ_OK) {
      atlas_free(own);
      return status;
    }
    p->atlas = own;
  }
  *atlas = p->atlas->atlas;
  return KZ_OK;
}
