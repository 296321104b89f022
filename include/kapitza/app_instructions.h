/* app: check of the CPU, for entries that are compiled for the first instruction set of its processor (C; layer 4). */
#pragma once

#include <stddef.h>

/* Instruction sets that this build can use beside the processor's first one; the program's entry refuses a CPU that
 * lacks one which it does. kz_instructions: for each of them "1" if the build uses it, then NULL. */
#ifdef __x86_64__
#define KZ_FIRST_INSTRUCTIONS "x86-64"
#define KZ_INSTRUCTION_LIST(X) \
  X(SSE3, "sse3")              \
  X(SSSE3, "ssse3")            \
  X(SSE4_1, "sse4.1")          \
  X(SSE4_2, "sse4.2")          \
  X(POPCNT, "popcnt")          \
  X(AVX, "avx")                \
  X(AVX2, "avx2")              \
  X(FMA, "fma")                \
  X(BMI, "bmi")                \
  X(BMI2, "bmi2")              \
  X(AVX512F, "avx512f")        \
  X(AVX512BW, "avx512bw")      \
  X(AVX512CD, "avx512cd")      \
  X(AVX512DQ, "avx512dq")      \
  X(AVX512VL, "avx512vl")
#else
#define KZ_FIRST_INSTRUCTIONS "armv8-a"
#define KZ_INSTRUCTION_LIST(X)
#endif
extern const char *const kz_instructions[];

/* The first instruction set that the build uses and this CPU lacks, or NULL. */
static inline const char *kz_missing_instruction(void) {
#ifdef __x86_64__
  size_t i = 0;
  __builtin_cpu_init();
#define KZ_CHECK(name, text) \
  if (kz_instructions[i++][0] == '1' && !__builtin_cpu_supports(text)) return text;
  KZ_INSTRUCTION_LIST(KZ_CHECK)
#undef KZ_CHECK
#endif
  return NULL;
}
