/* common: what every layer may use. Status codes of every function that can fail, and the one message that a user will see.
 *
 * A failing function sets the message once, where it knows most (kz_fail), and returns the code; callers carry the code up
 * with KZ_TRY. Only app/main.c prints the message and ends the program. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The value is the exit status of the program. */
typedef enum {
  KZ_OK = 0,       /* done */
  KZ_FAILED = 1,   /* failed while running */
  KZ_REFUSED = 2,  /* the command line, the scene or a path is wrong */
  KZ_STOPPED = 75, /* stopped early on request, all finished work is saved */
} kz_status;

enum { KZ_MESSAGE_BYTES = 2048 }; /* longest message, its end included */

/* Sets the message (printf format, without "kapitza: error:") and returns `status`. The first message stays: later ones
 * are consequences. */
kz_status kz_fail(kz_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The message set by the first kz_fail of this thread since its last kz_message_clear; "" if none. */
const char *kz_message(void);
void kz_message_clear(void);

#define KZ_TRY(call)                                  \
  do {                                                \
    kz_status kz_try_status = (call);                 \
    if (kz_try_status != KZ_OK) return kz_try_status; \
  } while (0)

/* Seconds of a clock that never runs backwards. */
double kz_clock(void);
/* Seconds of processor time of this thread, independent of other processes. */
double kz_processor_clock(void);
/* The same of all threads of the process. */
double kz_process_clock(void);

/* ---- quad precision ---- */

/* Numbers of 113 bits, Fortran's real128. Where gcc lacks this name of x86 it knows the standard's. */
#ifndef __SIZEOF_FLOAT128__
#define __float128 _Float128
#endif
/* Of the C library, whose headers declare them for gcc alone. */
__float128 ldexpf128(__float128 x, int exponent);
__float128 frexpf128(__float128 x, int *exponent);
__float128 strtof128(const char *text, char **end);
void sincosf128(__float128 x, __float128 *sine, __float128 *cosine);

/* ---- words ---- */

/* Words of scenes and files, in the order of their codes (KZ_METHOD_ICM ..., KZ_LINEAR ...). */
#define KZ_METHOD_WORDS "icm", "direct", "exact"
#define KZ_INTERPOLATION_WORDS "linear", "quintic"

/* What a macro stands for, as text. */
#define KZ_WRITTEN(name) KZ_WRITTEN_AS(name)
#define KZ_WRITTEN_AS(number) #number

/* Such a list of two or three words as one text, "icm|direct|exact". */
#define KZ_JOINED(words) KZ_JOINED_OF(words)
#define KZ_JOINED_OF(first, second, ...) first "|" second __VA_OPT__("|" __VA_ARGS__)

/* Adds a word to such a text of `bytes` bytes, which begins as "". */
void kz_words_add(char *words, size_t bytes, const char *word);
/* The next word of `rest`, with its length, not ended by a zero; `rest` moves behind it. NULL: there is none. */
const char *kz_words_next(const char **rest, int *length);

/* ---- memory ---- */

/* These functions never return NULL when bytes are requested, so callers do not check. If memory runs out, the rank prints one line, the
 * checkpoint keeps the finished work, and all ranks end (src/app/abandon.c). The linker redirects the calls that gfortran makes for
 * automatic arrays, temporaries and copies of components to the same functions (cmake/Layers.cmake); allocate(stat=) would not catch
 * these. */

/* As malloc, calloc, realloc, strdup and strndup of C. */
void *kz_malloc(size_t bytes);
void *kz_calloc(size_t n, size_t bytes);
void *kz_realloc(void *old, size_t bytes);
char *kz_strdup(const char *text);
char *kz_strndup(const char *text, size_t length);
/* Returns the list, of kz_malloc and the others or NULL, with space for n items of `item` bytes. A list whose
 * capacity is less moves to twice its space at least. *capacity: items that it has space for, 0 if that is not
 * known. */
void *kz_list_reserve(void *list, int64_t *capacity, int64_t n, size_t item);

static inline int64_t kz_smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}
static inline int64_t kz_larger(int64_t a, int64_t b) {
  return a > b ? a : b;
}

/* Before the declaration of a local variable: what it points to, or, by a function of its own, what it holds is freed when the function
 * returns, from whatever place. */
#define KZ_FREED KZ_FREED_BY(kz_free_local)
#define KZ_FREED_BY(release) __attribute__((cleanup(release)))
void kz_free_local(void *variable);

/* True if `bytes` bytes could be allocated now. Nothing is allocated. */
bool kz_memory_is_there(size_t bytes);
/* Fails with the key of a request that `needed` bytes are for, where these could not be allocated now. */
kz_status kz_memory_ask(const char *key, size_t needed);

/* Sets the function that is called when memory runs out; `leave` must end the process. Default: abort. */
void kz_memory_on_failure(void (*leave)(void));
