/* Runs of scenes in the process of the caller. HDF5 serves one thread at a time. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../library.h"
#include "kapitza/store.h"

static pthread_mutex_t one_run = PTHREAD_MUTEX_INITIALIZER;

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
  pthread_mutex_lock(&one_run);
  const kz_status status = kz_border_call(border, kz_library_pause(), NULL, run_scene, &j, &left);
  const kapitza_status told = kz_library_status(status, border);
  if (left && j.store) kz_border_call(border, NULL, NULL, run_discard, j.store, &again);
  pthread_mutex_unlock(&one_run);
  kz_border_free(border);
  return told;
}
