/* Waits end when their seconds have passed, although somebody sets the clock back meanwhile. */
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
#include "../../tools/test.h"

#include "kapitza/common_threads.h"

/* The clock of the day, 1000 s later than the one by which the system ends waits: that one has been set back. */
int clock_gettime(clockid_t clock, struct timespec *now) {
  const int status = (int)syscall(SYS_clock_gettime, clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec += 1000;
  return status;
}

TEST(test_waits_do_not_depend_on_the_clock_of_the_day) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t changed;
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  assert_true(now.tv_sec > 1000);
  kz_condition_make(&changed);
  alarm(60); /* ends a test that would wait for 1000 s */
  pthread_mutex_lock(&mutex);
  kz_thread_wait(&changed, &mutex, 0.001);
  pthread_mutex_unlock(&mutex);
  alarm(0);
  pthread_cond_destroy(&changed);
}
