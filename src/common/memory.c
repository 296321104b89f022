#include "kapitza/common.h"

#include <stdlib.h>

static void (*on_failure)(void) = abort;

void kz_memory_on_failure(void (*leave)(void)) {
  on_failure = leave;
}

static void *checked(void *memory, size_t bytes) {
  if (!memory && bytes > 0) on_failure();
  return memory;
}

void *kz_malloc(size_t bytes) {
  return checked(malloc(bytes), bytes);
}

void *kz_calloc(size_t n, size_t bytes) {
  return checked(calloc(n, bytes), n > 0 ? bytes : 0);
}

void *kz_realloc(void *old, size_t bytes) {
  return checked(realloc(old, bytes), bytes);
}
