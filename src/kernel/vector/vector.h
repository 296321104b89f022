/* Lanes of a batch and vectors of them, for the C loops of the kernel. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { KZ_LANES = 64 }; /* Lanes of a batch, WIDTH of map.f90 */

#if defined __AVX512F__
enum { VECTOR_BYTES = 64 };
#elif defined __AVX__
enum { VECTOR_BYTES = 32 };
#else
enum { VECTOR_BYTES = 16 };
#endif
typedef double vector __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(double)), may_alias));

#define KZ_INLINE static inline __attribute__((always_inline))
