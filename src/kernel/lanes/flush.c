/* Whether the processor takes subnormal numbers for 0. Orbits that decay onto an exact equilibrium end in them, and arithmetic
 * with them is some fifteen times slower. Processors that are not named here keep their slow ones: the numbers are the same to
 * 1e-300. */
#include <stdint.h>

/* The control word as it was; from now on subnormal numbers are 0. */
uint64_t kz_flush_subnormals(void);
/* Puts a control word back. */
void kz_restore_control(uint64_t control);

#if defined(__SSE2__)

#include <immintrin.h>

enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };

static uint64_t control_word(void) {
  return _mm_getcsr();
}

static void set_control_word(uint64_t control) {
  _mm_setcsr((uint32_t)control);
}

#elif defined(__aarch64__)

enum { FLUSH_TO_ZERO = 1 << 24, DENORMALS_ARE_ZERO = 0 };

static uint64_t control_word(void) {
  uint64_t control;
  __asm__ volatile("mrs %0, fpcr" : "=r"(control));
  return control;
}

static void set_control_word(uint64_t control) {
  __asm__ volatile("msr fpcr, %0" : : "r"(control));
}

#else

enum { FLUSH_TO_ZERO = 0, DENORMALS_ARE_ZERO = 0 };

static uint64_t control_word(void) {
  return 0;
}

static void set_control_word(uint64_t control) {
  (void)control;
}

#endif

uint64_t kz_flush_subnormals(void) {
  const uint64_t control = control_word();
  set_control_word(control | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
  return control;
}

void kz_restore_control(uint64_t control) {
  set_control_word(control);
}
