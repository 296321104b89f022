/* Compiled, like all layers, for the instruction set of the build: what the compiler says here is what the program uses. */
#include <string.h>

#include "app.h"

enum {
#define BIT(name, bit, text) name##_BIT = 1u << bit,
  KZ_INSTRUCTION_LIST(BIT)
#undef BIT
};

const unsigned kz_instructions = 0u
#ifdef __SSE3__
                                 | SSE3_BIT
#endif
#ifdef __SSSE3__
                                 | SSSE3_BIT
#endif
#ifdef __SSE4_1__
                                 | SSE4_1_BIT
#endif
#ifdef __SSE4_2__
                                 | SSE4_2_BIT
#endif
#ifdef __POPCNT__
                                 | POPCNT_BIT
#endif
#ifdef __AVX__
                                 | AVX_BIT
#endif
#ifdef __AVX2__
                                 | AVX2_BIT
#endif
#ifdef __FMA__
                                 | FMA_BIT
#endif
#ifdef __BMI__
                                 | BMI_BIT
#endif
#ifdef __BMI2__
                                 | BMI2_BIT
#endif
#ifdef __AVX512F__
                                 | AVX512F_BIT
#endif
#ifdef __AVX512BW__
                                 | AVX512BW_BIT
#endif
#ifdef __AVX512CD__
                                 | AVX512CD_BIT
#endif
#ifdef __AVX512DQ__
                                 | AVX512DQ_BIT
#endif
#ifdef __AVX512VL__
                                 | AVX512VL_BIT
#endif
    ;

const char *kz_instruction_names(void) {
  static char names[256];
  names[0] = '\0';
#define APPEND(name, bit, text)                                            \
  if (kz_instructions & name##_BIT) {                                      \
    strncat(names, names[0] ? " " : "", sizeof names - strlen(names) - 1); \
    strncat(names, text, sizeof names - strlen(names) - 1);                \
  }
  KZ_INSTRUCTION_LIST(APPEND)
#undef APPEND
  return names[0] ? names : "x86-64";
}
