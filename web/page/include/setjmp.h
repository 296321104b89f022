/* Jumps out of a call: system.c. */
#pragma once
typedef int jmp_buf[1];
int setjmp(jmp_buf place);
_Noreturn void longjmp(jmp_buf place, int value);
