/* The inner loop of the processed splitting in single and double precision: one text, two kinds of real. Written with the
 * compilers' vector types because gfortran does not keep the states in registers (1.5 times slower). Operations per lane and
 * kick: a drift (n_drift + 1), the reduction to the nearest even half-turn (3), an odd polynomial (n_kick + 2). */
#include <stdint.h>

#if defined __AVX512F__
enum { VECTOR_BYTES = 64 };
#else
enum { VECTOR_BYTES = 32 };
#endif
/* Lanes of a tile (lanes/map.f90): blocks divide it. */
enum { WIDTH = 64 };
#define EACH _Pragma("GCC unroll 8") for (int i = 0; i < CHAINS; i++)

/* Adding it rounds to an even integer. */
#define MAGIC 0x3p52
#define real double
#define VECTOR vector_r64
#define NAMED(name) name##_r64
#include "stages.inc"
#undef MAGIC
#undef real
#undef VECTOR
#undef NAMED

#define MAGIC 0x3p23f
#define real float
#define VECTOR vector_r32
#define NAMED(name) name##_r32
#include "stages.inc"
