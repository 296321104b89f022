/* Numbers of any precision: FLINT's (Arb), without their radii. */
#pragma once

#include "kapitza/kernel_digits.h"

#if __has_include(<flint/arb.h>)
#include <flint/arb.h>
#include <flint/fmpq.h>
#else
#include <arb.h>
#endif

typedef arb_struct kz_number;

/* Allocates n numbers, all 0. */
kz_number *kz_numbers_make(int64_t n);
void kz_numbers_free(kz_number *numbers, int64_t n);

/* Converts a coordinate of a start, with an error of at most 2^-bits. */
void kz_number_of(const kz_coordinate *coordinate, kz_number *x, int64_t bits);
void kz_number_of_quad(__float128 value, kz_number *x);
__float128 kz_number_quad(const kz_number *x);
long double kz_number_long(const kz_number *x);

void kz_number_two_pi(kz_number *x, int64_t bits);
void kz_number_sin_cos(const kz_number *x, kz_number *sine, kz_number *cosine, int64_t bits);
/* Sine and cosine of 2 pi i / n. */
void kz_number_sin_cos_of_turns(int64_t i, int64_t n, kz_number *sine, kz_number *cosine, int64_t bits);

/* Writes x as text [size] that reads back exactly; false if it does not fit. */
bool kz_number_write(const kz_number *x, char *text, size_t size);
bool kz_number_read(const char *text, kz_number *x);

/* Arithmetic. Results are rounded to `bits` significant bits towards 0, so that mirrored numbers stay mirrored. */
static inline void kz_number_init(kz_number *x) {
  arb_init(x);
}
static inline void kz_number_clear(kz_number *x) {
  arb_clear(x);
}
static inline void kz_number_set(kz_number *x, const kz_number *a) {
  arf_set(arb_midref(x), arb_midref(a));
}
static inline void kz_number_round(kz_number *x, int64_t bits) {
  arf_set_round(arb_midref(x), arb_midref(x), bits, ARF_RND_DOWN);
}
static inline void kz_number_of_double(double value, kz_number *x) {
  arf_set_d(arb_midref(x), value);
}
static inline double kz_number_double(const kz_number *x) {
  return arf_get_d(arb_midref(x), ARF_RND_NEAR);
}
#define KZ_ROUNDED(name, operation)                                                             \
  static inline void name(kz_number *x, const kz_number *a, const kz_number *b, int64_t bits) { \
    operation(arb_midref(x), arb_midref(a), arb_midref(b), bits, ARF_RND_DOWN);                 \
  }
KZ_ROUNDED(kz_number_add, arf_add)
KZ_ROUNDED(kz_number_subtract, arf_sub)
KZ_ROUNDED(kz_number_multiply, arf_mul)
KZ_ROUNDED(kz_number_divide, arf_div)
static inline void kz_number_divide_by(kz_number *x, const kz_number *a, int64_t n, int64_t bits) {
  arf_div_si(arb_midref(x), arb_midref(a), n, bits, ARF_RND_DOWN);
}
static inline void kz_number_multiply_by(kz_number *x, int64_t n, int64_t bits) {
  arf_mul_si(arb_midref(x), arb_midref(x), n, bits, ARF_RND_DOWN);
}
static inline void kz_number_floor(kz_number *x, const kz_number *a) {
  arf_floor(arb_midref(x), arb_midref(a));
}
static inline bool kz_number_is_less(const kz_number *a, double b) {
  return arf_cmp_d(arb_midref(a), b) < 0;
}
/* Least e with |x| < 2^e; INT32_MIN for 0. */
static inline int64_t kz_number_exponent(const kz_number *x) {
  return arf_is_zero(arb_midref(x)) ? INT32_MIN : fmpz_get_si(ARF_EXPREF(arb_midref(x)));
}
/* x = first + sum, or first - sum if `minus`, of a[i] b[-i], i = 0 .. n - 1; first NULL = 0. */
static inline void kz_number_dot(kz_number *x, const kz_number *first, bool minus, const kz_number *a,
                                 const kz_number *b, int64_t n, int64_t bits) {
  arb_approx_dot(x, first, minus, a, 1, b, -1, n, bits);
}

/* Declares a number, 0 at first, that is freed at the end of its block. */
#define KZ_NUMBER(x)                                     \
  kz_number x __attribute__((cleanup(kz_number_clear))); \
  kz_number_init(&x)
