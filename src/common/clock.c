#include <time.h>

#include "kapitza/common.h"

static double seconds_of(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double kz_clock(void) {
  return seconds_of(CLOCK_MONOTONIC);
}

double kz_processor_clock(void) {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double kz_process_clock(void) {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}
