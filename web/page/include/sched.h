/* Processors of a tab's engine: one. */
#pragma once
typedef struct {
  int one;
} cpu_set_t;
#define CPU_COUNT(set) 1
#define sched_getaffinity(process, bytes, set) (-1)
#define sched_yield() 0
