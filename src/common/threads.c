#include "kapitza/common_threads.h"

#include "kapitza/common_border.h"

#include <signal.h>
#include <time.h>

bool kz_thread_start(pthread_t *thread, size_t stack_bytes, void *(*work)(void *context), void *context) {
  pthread_attr_t attributes;
  sigset_t all, before;
  if (pthread_attr_init(&attributes) != 0) return false;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const bool started = pthread_attr_setstacksize(&attributes, stack_bytes) == 0 &&
                       pthread_create(thread, &attributes, work, context) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  pthread_attr_destroy(&attributes);
  return started;
}

void kz_condition_make(pthread_cond_t *condition) {
  pthread_condattr_t attributes;
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(condition, &attributes);
  pthread_condattr_destroy(&attributes);
}

void kz_thread_wait(pthread_cond_t *changed, pthread_mutex_t *mutex, double seconds) {
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  const double end = (double)until.tv_nsec * 1e-9 + seconds;
  until.tv_sec += (time_t)floor(end);
  until.tv_nsec = (long)((end - floor(end)) * 1e9);
  pthread_cond_timedwait(changed, mutex, &until);
}

struct kz_lock {
  pthread_mutex_t mutex;
};

kz_lock *kz_lock_create(void) {
  kz_lock *lock = kz_malloc(sizeof *lock);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
  pthread_mutex_init(&lock->mutex, &attributes);
  pthread_mutexattr_destroy(&attributes);
  return lock;
}

void kz_lock_free(kz_lock *lock) {
  if (lock) pthread_mutex_destroy(&lock->mutex);
  free(lock);
}

void kz_lock_take(kz_lock *lock) {
  pthread_mutex_lock(&lock->mutex);
  kz_border_lock(&lock->mutex);
}

void kz_lock_leave(kz_lock *lock) {
  kz_border_unlock(&lock->mutex);
  pthread_mutex_unlock(&lock->mutex);
}
