/* What a tab lacks of a system: time, memory, quad precision under the names of glibc and flang; and calls of the page.
 */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "kapitza.h"

#define PAGE(name) __attribute__((import_module("page"), import_name(#name)))
#define SHOWN(name) __attribute__((export_name(#name)))
PAGE(now) double page_now(void);
PAGE(show) int page_show(void *context, const void *part);
PAGE(between) int page_between(void *context);
PAGE(stop) _Noreturn void page_stop(int code);

/* ---- calls of the page ---- */

SHOWN(page_frame) kapitza_status page_frame(kapitza_pendulum *pendulum, const kapitza_frame_request *request) {
  return kapitza_frame(pendulum, request, (kapitza_show)page_show, page_between, NULL);
}

SHOWN(page_chart)
kapitza_status page_chart(kapitza_pendulum *pendulum, const char *change, int32_t n_parts, const int32_t *coarseness) {
  return kapitza_chart(pendulum, change, n_parts, coarseness, (kapitza_show_chart)page_show, page_between, NULL);
}

SHOWN(page_malloc) void *page_malloc(size_t bytes) {
  return malloc(bytes);
}

/* Whether this build may be used: relaxed multiply-adds are fused on this processor. */
SHOWN(page_fits) int page_fits(void) {
#ifdef __wasm_relaxed_simd__
  typedef double lanes __attribute__((vector_size(16)));
  volatile double x = 1 + 0x1p-30, y = -(x * x);
  const lanes a = {x, x}, c = {y, y}, rest = __builtin_wasm_relaxed_madd_f64x2(a, a, c);
  return rest[0] == 0x1p-60 && rest[1] == 0x1p-60;
#else
  return 1;
#endif
}

/* ---- the system ---- */

_Noreturn void _Exit(int code) {
  page_stop(code);
}
_Noreturn void abort(void) {
  page_stop(134);
}
void *sbrk(intptr_t by) {
  const size_t pages = __builtin_wasm_memory_size(0);
  if (by <= 0) return (void *)(pages << 16);
  if (__builtin_wasm_memory_grow(0, ((size_t)by + 65535) >> 16) != (size_t)-1) return (void *)(pages << 16);
  errno = ENOMEM;
  return (void *)-1;
}
int clock_gettime(clockid_t clock, struct timespec *now) {
  const double seconds = page_now() * 1e-3;
  (void)clock;
  now->tv_sec = (time_t)seconds;
  now->tv_nsec = (long)((seconds - (double)now->tv_sec) * 1e9);
  return 0;
}
int getpid(void) {
  return 1;
}
long sysconf(int name) {
  (void)name;
  return 1;
}
void __wasilibc_ensure_environ(void) {}
char *getenv(const char *name) {
  (void)name;
  return NULL;
}

/* Leaving a call in its middle ends the engine: the page begins another one. */
int setjmp(int *place) {
  (void)place;
  return 0;
}
_Noreturn void longjmp(int *place, int value) {
  (void)place;
  page_stop(value);
}

/* ---- quad precision, which is long double here ---- */

typedef long double quad;
#define UNARY(name, function) \
  quad name(quad x) {         \
    return function(x);       \
  }
UNARY(_FortranASinF128, sinl)
UNARY(_FortranACosF128, cosl)
UNARY(_FortranACoshF128, coshl)
UNARY(_FortranAExpF128, expl)
UNARY(_FortranASqrtF128, sqrtl)
UNARY(_FortranAAtanF128, atanl)
UNARY(_FortranAFloorF128, floorl)
UNARY(_FortranARoundF128, roundl)
UNARY(_FortranATruncF128, truncl)
quad _FortranAAtan2F128(quad y, quad x) {
  return atan2l(y, x);
}
quad _FortranAHypotF128(quad x, quad y) {
  return hypotl(x, y);
}
int64_t _FortranALlroundF128(quad x) {
  return llroundl(x);
}
quad strtof128(const char *text, char **end) {
  return strtold(text, end);
}
quad ldexpf128(quad x, int e) {
  return ldexpl(x, e);
}
quad frexpf128(quad x, int *e) {
  return frexpl(x, e);
}
void sincosf128(quad x, quad *s, quad *c) {
  *s = sinl(x);
  *c = cosl(x);
}
int page_lround(double x) {
  return (int)lround(x);
}
double page_cabs(double re, double im) {
  return hypot(re, im);
}

/* compiler-rt for wasm64 declares comparisons of quads with a wider result than LLVM calls. */
static int order(quad x, quad y, int unordered) {
  unsigned __int128 a, b;
  const unsigned __int128 sign = (unsigned __int128)1 << 127, infinity = (unsigned __int128)0x7fff << 112;
  memcpy(&a, &x, 16);
  memcpy(&b, &y, 16);
  if ((a & ~sign) > infinity || (b & ~sign) > infinity) return unordered;
  if (((a | b) & ~sign) == 0 || a == b) return 0;
  const __int128 s = a & sign ? -(__int128)(a & ~sign) : (__int128)a;
  return s < (b & sign ? -(__int128)(b & ~sign) : (__int128)b) ? -1 : 1;
}
#define ORDER(name, unordered)               \
  int page##name(quad, quad) __asm__(#name); \
  int page##name(quad a, quad b) {           \
    return order(a, b, unordered);           \
  }
ORDER(__eqtf2, 1)
ORDER(__netf2, 1)
ORDER(__lttf2, 1)
ORDER(__letf2, 1)
ORDER(__gttf2, -1)
ORDER(__getf2, -1)
int page__unordtf2(quad, quad) __asm__("__unordtf2");
int page__unordtf2(quad a, quad b) {
  return order(a, b, 2) == 2;
}

/* ---- floating-point environment: none ---- */

int _FortranAMapException(int exception) {
  return exception & 0;
}
int feenableexcept(int exceptions) {
  return exceptions & 0;
}
int fedisableexcept(int exceptions) {
  return exceptions & 0;
}
int fegetexcept(void) {
  return 0;
}
