#include "kapitza/common_border.h"

static void (*on_failure)(void) = abort;

void kz_memory_on_failure(void (*leave)(void)) {
  on_failure = leave;
}

/* Names by which the linker redirects malloc to __wrap_malloc, and __real_malloc to malloc (cmake/Layers.cmake). */
void *__real_malloc(size_t bytes);
void *__real_calloc(size_t n, size_t bytes);
void *__real_realloc(void *old, size_t bytes);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t n, size_t bytes);
void *__wrap_realloc(void *old, size_t bytes);
/* In the library alone: what is freed is no longer the border's. */
void __real_free(void *memory);
void __wrap_free(void *memory);

static void *checked_memory(void *memory, size_t bytes) {
  if (!memory && bytes > 0) {
    kz_border_without_memory();
    on_failure();
  }
  kz_border_keep(memory);
  kz_look();
  return memory;
}

void __wrap_free(void *memory) {
  kz_border_forget(memory);
  __real_free(memory);
}

void *__wrap_malloc(size_t bytes) {
  return checked_memory(__real_malloc(bytes), bytes);
}

void *__wrap_calloc(size_t n, size_t bytes) {
  return checked_memory(__real_calloc(n, bytes), n > 0 ? bytes : 0);
}

void *__wrap_realloc(void *old, size_t bytes) {
  kz_border_forget(old);
  void *memory = __real_realloc(old, bytes);
  if (!memory && bytes > 0) kz_border_keep(old);
  return checked_memory(memory, bytes);
}

void *kz_malloc(size_t bytes) {
  return __wrap_malloc(bytes);
}

void *kz_calloc(size_t n, size_t bytes) {
  return __wrap_calloc(n, bytes);
}

void *kz_realloc(void *old, size_t bytes) {
  return __wrap_realloc(old, bytes);
}

void *kz_list_reserve(void *list, int64_t *capacity, int64_t n, size_t item) {
  if (n <= *capacity) return list;
  *capacity = n > 2 * *capacity ? n : 2 * *capacity;
  return kz_realloc(list, (size_t)*capacity * item);
}

char *kz_strndup(const char *text, size_t length) {
  const size_t n = strnlen(text, length);
  char *copy = kz_malloc(n + 1);
  memcpy(copy, text, n);
  copy[n] = '\0';
  return copy;
}

char *kz_strdup(const char *text) {
  return kz_strndup(text, strlen(text));
}

void kz_free_local(void *variable) {
  void *memory;
  memcpy(&memory, variable, sizeof memory);
  free(memory);
}

bool kz_memory_is_there(size_t bytes) {
  void *volatile memory = __real_malloc(bytes);
  free(memory);
  return memory != NULL;
}

kz_status kz_memory_ask(const char *key, size_t needed) {
  if (kz_memory_is_there(needed)) return KZ_OK;
  kz_border_lacks();
  return kz_fail(KZ_FAILED, "request: %s: needs %zu MB of memory, more than there are", key, needed >> 20);
}
