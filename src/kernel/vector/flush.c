/* Whether the processor takes subnormal numbers for 0. Orbits that decay onto an exact equilibrium end in them, and arithmetic
 * with them is some fifteen times slower. */
#include <immintrin.h>
#include <stdint.h>

enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };

/* The control word as it was; from now on subnormal numbers are 0. */
uint64_t kz_flush_subnormals(void) {
  const unsigned control = _mm_getcsr();
  _mm_setcsr(control | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
  return control;
}

/* Puts a control word back. */
void kz_restore_control(uint64_t control) {
  _mm_setcsr((unsigned)control);
}
