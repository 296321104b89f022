/* Flushing of subnormals, which are fifteen times slower on x86; orbits that decay onto an equilibrium end in them. */
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
#elif defined __wasm__
enum { FLUSH_TO_ZERO, DENORMALS_ARE_ZERO = 0 }; /* it has no control word, and takes subnormals as they are */

static uint64_t read_control(void) {
  return 0;
}
static void write_control(uint64_t control) {
  (void)control;
}
#else
#error "the control word of this processor is not known"
#endif

/* Makes the processor take subnormal numbers for 0; returns the control word for kz_restore_control. Every batch of
 * periods begins with it, so it also looks for a stop request. */
uint64_t kz_flush_subnormals(void) {
  kz_look();
  const uint64_t control = read_control();
  write_control(control | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
  return control;
}

/* Restores a control word. */
void kz_restore_control(uint64_t control) {
  write_control(control);
}
