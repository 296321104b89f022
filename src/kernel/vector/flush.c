/* Whether the processor takes subnormal numbers for 0. Orbits that decay onto an exact equilibrium end in them, and arithmetic
 * with them is some fifteen times slower on x86. */
#include <stdint.h>

#include "kapitza/common_border.h"

#ifdef __x86_64__
#include <immintrin.h>

enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };

static uint64_t read_control(void) {
  return _mm_getcsr();
}
static void write_control(uint64_t control) {
  _mm_setcsr((unsigned)control);
}
#elif defined __aarch64__
enum { FLUSH_TO_ZERO = 1 << 24, DENORMALS_ARE_ZERO = 0 }; /* one bit for both */

static uint64_t read_control(void) {
  uint64_t control;
  __asm__ volatile("mrs %0, fpcr" : "=r"(control));
  return control;
}
static void write_control(uint64_t control) {
  __asm__ volatile("msr fpcr, %0" : : "r"(control));
}
#else
#error "the control word of this processor is not known"
#endif

/* The control word as it was; from now on subnormal numbers are 0. Every batch of periods begins with it, so that it looks for a stop request. */
uint64_t kz_flush_subnormals(void) {
  kz_look();
  const uint64_t control = read_control();
  write_control(control | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
  return control;
}

/* Puts a control word back. */
void kz_restore_control(uint64_t control) {
  write_control(control);
}
