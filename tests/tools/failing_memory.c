/* A malloc that fails on purpose, for LD_PRELOAD. Allocations of at least KZ_FAIL_BYTES by the program and the
 * libraries named in KZ_FAIL_CALLERS (parts of file names, joined by ':'; default: the program) are counted on rank
 * KZ_FAIL_RANK (default: every one); number KZ_FAIL_FIRST and those after it fail, KZ_FAIL_COUNT of them. With
 * KZ_FAIL_TALLY the count is written to that file, whose name ends with the rank. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t n, size_t bytes);
void *__libc_realloc(void *old, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);

static struct {
  bool known, here;
  long long first, count;
  size_t bytes;
  const char *callers;
} plan;
static long long counted;

static long long failing_memory_number(const char *name, long long fallback) {
  const char *text = getenv(name);
  return text ? atoll(text) : fallback;
}

static void read_plan(void) {
  const char *rank = getenv("KZ_FAIL_RANK"), *own = getenv("OMPI_COMM_WORLD_RANK");
  plan.known = true;
  plan.callers = getenv("KZ_FAIL_CALLERS");
  plan.here = (plan.callers || strcmp(program_invocation_short_name, "kapitza") == 0) &&
              (!rank || strcmp(rank, own ? own : "0") == 0);
  plan.first = failing_memory_number("KZ_FAIL_FIRST", INT64_MAX);
  plan.count = failing_memory_number("KZ_FAIL_COUNT", 1);
  plan.bytes = (size_t)failing_memory_number("KZ_FAIL_BYTES", 0);
}

/* Whether the code at `address` belongs to the program or a library that is named. */
static bool failing_memory_counts(const void *address) {
  Dl_info object;
  if (!dladdr(address, &object) || !object.dli_fname) return false;
  const char *slash = strrchr(object.dli_fname, '/'), *file = slash ? slash + 1 : object.dli_fname;
  for (const char *name = plan.callers ? plan.callers : program_invocation_short_name; *name;) {
    const size_t n = strcspn(name, ":");
    if (memmem(file, strlen(file), name, n)) return true;
    name += n + (name[n] == ':');
  }
  return false;
}

/* Within a process: counts anew, and lets allocation `first` fail; how many there were since then. */
void kz_fail_at(long long first);
void kz_fail_at(long long first) {
  if (!plan.known) read_plan();
  plan.first = first;
  counted = 0;
}

long long kz_fail_count(void);
long long kz_fail_count(void) {
  return counted;
}

static bool failing_memory_fails(size_t bytes, const void *caller) {
  if (!plan.known) read_plan();
  if (!plan.here || bytes < plan.bytes || !failing_memory_counts(caller)) return false;
  const long long n = __atomic_add_fetch(&counted, 1, __ATOMIC_RELAXED);
  if (n < plan.first || n - plan.first >= plan.count) return false;
  errno = ENOMEM;
  return true;
}

void *malloc(size_t bytes) {
  return failing_memory_fails(bytes, __builtin_return_address(0)) ? NULL : __libc_malloc(bytes);
}

void *calloc(size_t n, size_t bytes) {
  return failing_memory_fails(n * bytes, __builtin_return_address(0)) ? NULL : __libc_calloc(n, bytes);
}

void *realloc(void *old, size_t bytes) {
  return failing_memory_fails(bytes, __builtin_return_address(0)) ? NULL : __libc_realloc(old, bytes);
}

void *memalign(size_t alignment, size_t bytes) {
  return failing_memory_fails(bytes, __builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}

void *aligned_alloc(size_t alignment, size_t bytes) {
  return failing_memory_fails(bytes, __builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}

int posix_memalign(void **memory, size_t alignment, size_t bytes) {
  if (failing_memory_fails(bytes, __builtin_return_address(0))) return ENOMEM;
  *memory = __libc_memalign(alignment, bytes);
  return *memory ? 0 : ENOMEM;
}

static char *failing_memory_copy(const char *text, size_t n, const void *caller) {
  char *memory = failing_memory_fails(n + 1, caller) ? NULL : __libc_malloc(n + 1);
  if (memory) memcpy(memory, text, n);
  if (memory) memory[n] = '\0';
  return memory;
}

char *strdup(const char *text) {
  return failing_memory_copy(text, strlen(text), __builtin_return_address(0));
}

char *strndup(const char *text, size_t n) {
  return failing_memory_copy(text, strnlen(text, n), __builtin_return_address(0));
}

__attribute__((destructor)) static void write_tally(void) {
  const char *path = getenv("KZ_FAIL_TALLY"), *rank = getenv("OMPI_COMM_WORLD_RANK");
  char name[4096];
  snprintf(name, sizeof name, "%s%s", path ? path : "", rank ? rank : "0");
  const int file = plan.here && path ? open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
  if (file < 0) return;
  dprintf(file, "%lld\n", counted);
  close(file);
}
