/* Status codes of every function that can fail, the one message that a user sees, words, and memory.
 *
 * A failing function sets the message once, where it knows most (kz_fail), and returns the code; callers carry the code
 * up with KZ_TRY. Only app/main.c prints the message and ends the program. */
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Status of a call, with the value of the program's exit status. */
typedef enum {
  KZ_OK = 0,       /* Done */
  KZ_FAILED = 1,   /* Failed while running */
  KZ_REFUSED = 2,  /* The command line, the scene or a path is wrong */
  KZ_STOPPED = 75, /* Stopped early on request, all finished work is saved */
} kz_status;

enum { KZ_MESSAGE_BYTES = 2048 }; /* Bytes of the longest message with its zero */

/* Sets the message (printf format, without "kapitza: error:") and returns `status`. The first message stays. */
kz_status kz_fail(kz_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Returns the message of the first kz_fail of this thread since its last kz_message_clear; "" if none. */
const char *kz_message(void);
void kz_message_clear(void);

#define KZ_TRY(call)                                  \
  do {                                                \
    kz_status kz_try_status = (call);                 \
    if (kz_try_status != KZ_OK) return kz_try_status; \
  } while (0)

/* Returns seconds of a clock that never runs backwards. */
double kz_clock(void);
/* Returns seconds of processor time of this thread. */
double kz_processor_clock(void);
/* Returns seconds of processor time of all threads of the process. */
double kz_process_clock(void);

/* ---- quad precision ---- */

/* Numbers of 113 bits, Fortran's real128. Non-x86: use the standard name _Float128. */
#ifndef __SIZEOF_FLOAT128__
#define __float128 _Float128
#endif
/* Functions of the C library, declared here because its headers hide them from other compilers. */
__float128 ldexpf128(__float128 x, int exponent);
__float128 frexpf128(__float128 x, int *exponent);
__float128 strtof128(const char *text, char **orbit_end);
void sincosf128(__float128 x, __float128 *sine, __float128 *turning_cosine);

/* ---- words ---- */

/* Words of scenes and files, in the order of their codes (KZ_METHOD_ICM ..., KZ_LINEAR ...). */
#define KZ_METHOD_WORDS "icm", "direct", "exact"
#define KZ_INTERPOLATION_WORDS "linear", "quintic"

/* The value of a macro as text. */
#define KZ_STRINGIFY(name) KZ_STRINGIFY_TOKENS(name)
#define KZ_STRINGIFY_TOKENS(number) #number

/* A list of two or three words as one text, "icm|direct|exact". */
#define KZ_JOIN_WORDS(words) KZ_JOIN_LIST(words)
#define KZ_JOIN_LIST(first, second, ...) first "|" second __VA_OPT__("|" __VA_ARGS__)

/* Adds a word to a text of words joined by '|', "" at first, in `words` [bytes]. */
void kz_words_add(char *keys_words, size_t phases_write_bytes, const char *word);
/* Returns the next word of `rest`, of *length bytes without a zero, and moves `rest` behind it; NULL if none. */
const char *kz_words_next(const char **uneven_rest, int *length);

/* ---- memory ---- */

/* Memory functions that never return NULL for more than 0 bytes, so callers do not check. If memory runs out, the rank
 * prints one line, the checkpoint keeps the finished work, and all ranks end (src/app/abandon.c). The linker redirects
 * gfortran's own allocations to them (cmake/Layers.cmake), which allocate(stat=) would not catch. */

/* Do what malloc, calloc, realloc, strdup and strndup of C do. */
void *kz_malloc(size_t phases_write_bytes);
void *kz_calloc(size_t n, size_t phases_bytes);
void *kz_realloc(void *old, size_t bytes);
char *kz_strdup(const char *text);
char *kz_strndup(const char *text, size_t length);
/* Returns the list (NULL or from kz_malloc) with space for n items of `item` bytes; it may move. *capacity: number of
 * items that it has space for, 0 if not known; at least doubles when it grows. */
void *kz_list_reserve(void *list, int64_t *capacity, int64_t n, size_t item);

static inline int64_t kz_smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}
static inline int64_t kz_larger(int64_t a, int64_t b) {
  return a > b ? a : b;
}

/* Attributes of a local variable whose target, or content by a function of its own, is freed at the end of its
 * block. */
#define KZ_AUTOFREE KZ_AUTOFREE_BY(kz_free_local)
#define KZ_AUTOFREE_BY(release) __attribute__((cleanup(release)))
void kz_free_local(void *variable);

/* Returns true if `bytes` bytes could be allocated now. */
bool kz_memory_is_there(size_t bytes);
/* Fails, naming the key of a request that needs them, if `needed` bytes could not be allocated now. */
kz_status kz_memory_ask(const char *key, size_t needed);

/* Sets the function that is called when memory runs out; `leave` must end the process. Default: abort. */
void kz_memory_on_failure(void (*abandon_leave)(void));
