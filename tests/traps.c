/* Linked into the unit tests of a debug build below the layer app: a division by zero, an overflow or an invalid
 * operation ends the test where it happens. (-ffpe-trap does nothing under a C main.) */
#define _GNU_SOURCE /* feenableexcept */
#include <fenv.h>

__attribute__((constructor)) static void trap_exceptions(void) {
  feenableexcept(FE_DIVBYZERO | FE_OVERFLOW | FE_INVALID);
}
