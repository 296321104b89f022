# Flags of the compilers that are known: GNU or Clang for C, GNU for Fortran. What labels and map tables promise depends on how products
# are rounded (-ffp-contract) and on quad precision, so another compiler is refused instead of being given flags that it may read otherwise.

if(NOT CMAKE_C_COMPILER_ID MATCHES "^(GNU|Clang)$")
  message(FATAL_ERROR "The C compiler is ${CMAKE_C_COMPILER_ID}; give -DCMAKE_C_COMPILER= one of GNU (gcc) or Clang (clang)")
endif()
if(NOT CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  message(FATAL_ERROR "The Fortran compiler is ${CMAKE_Fortran_COMPILER_ID}; give -DCMAKE_Fortran_COMPILER= that of GNU (gfortran)")
endif()

# Large arrays belong to the heap: users and batch systems limit the stack (kz_app, src/app/main.c).
set(KAPITZA_WARNINGS -Wall -Wextra)
if(KAPITZA_WERROR)
  list(APPEND KAPITZA_WARNINGS -Werror)
endif()
if(NOT KAPITZA_SANITIZE) # they take room of their own
  list(APPEND KAPITZA_WARNINGS -Wframe-larger-than=163840)
endif()
# A pendulum is often {k, beta, m} alone: what is left out is 0. Vectors are not passed between object files, so their ABI is free.
# KAPITZA_FUSED tells a source what its flags say of products: sources that need one of the two refuse the other (src/kernel).
set(KAPITZA_FLAGS_C ${KAPITZA_WARNINGS} -Wno-missing-field-initializers -Wno-psabi -Wshadow -Wstrict-prototypes -Wswitch-enum -Wvla
    -ffp-contract=off -fvisibility=hidden -fno-semantic-interposition -DKAPITZA_FUSED=0)
set(KAPITZA_FLAGS_FORTRAN ${KAPITZA_WARNINGS} -Wimplicit-interface -fimplicit-none -ffree-line-length-none
    -ffp-contract=fast -fno-trapping-math -fno-math-errno -fno-semantic-interposition)
set(CMAKE_POSITION_INDEPENDENT_CODE ON) # the same objects are the program's and the library's
if(KAPITZA_SANITIZE) # gfortran 12 warns of array descriptors inside derived types there, which nothing reads before they are set
  list(APPEND KAPITZA_FLAGS_FORTRAN -Wno-maybe-uninitialized)
endif()
# The flow of a state and that with tangents must round alike, and a start alone as beside others. Without optimization of loops gfortran fuses
# other products in one than in the other; on aarch64, whose vectors have two lanes, it does so in loops as well.
if(KAPITZA_SANITIZE OR CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  list(APPEND KAPITZA_FLAGS_FORTRAN -ffp-contract=off)
endif()
# -g1: functions and lines for backtraces and profiles. All variables would take a third more time to compile.
set(CMAKE_C_FLAGS_RELEASE "-O2 -g1")
set(CMAKE_Fortran_FLAGS_RELEASE "-O3 -g1")
set(CMAKE_C_FLAGS_DEBUG "-O1 -g1")
set(CMAKE_Fortran_FLAGS_DEBUG "-O1 -g1 -fcheck=all,no-array-temps -fbacktrace")

set(KAPITZA_SANITIZERS "")
if(KAPITZA_SANITIZE)
  # -fcheck=all looks after Fortran's bounds and pointers; to look twice takes as long again, to compile and to run.
  set(KAPITZA_SANITIZERS -fsanitize=address -fno-sanitize-recover=undefined -fno-omit-frame-pointer
      $<$<COMPILE_LANGUAGE:C>:-fsanitize=undefined>
      $<$<COMPILE_LANGUAGE:Fortran>:-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero,float-cast-overflow>)
  link_libraries(-fsanitize=address,undefined)
endif()
