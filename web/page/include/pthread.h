/* Threads of a tab's engine: there is one, which begins no others. */
#pragma once
#include <signal.h>
#include <stddef.h>
#include <sys/types.h>
#include <time.h>

#define pthread_t unsigned long
#define pthread_attr_t int
#define pthread_mutexattr_t int
#define pthread_condattr_t int
#define pthread_rwlockattr_t int
#define pthread_once_t int
#define pthread_key_t int
#define pthread_mutex_t int
#define pthread_cond_t int
#define pthread_rwlock_t int
enum { PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER = 0, PTHREAD_ONCE_INIT = 0 };
enum { PTHREAD_MUTEX_RECURSIVE = 1, PTHREAD_MUTEX_ERRORCHECK, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP };
enum { PTHREAD_RWLOCK_INITIALIZER, NO_THREADS = 11 };

static inline int page_nothing(const void *first, ...) {
  (void)first;
  return 0;
}
#define pthread_attr_init(...) page_nothing(__VA_ARGS__)
#define pthread_attr_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_attr_setstacksize(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_init(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_lock(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_trylock(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_timedlock(...) page_nothing(__VA_ARGS__)
#define pthread_mutex_unlock(...) page_nothing(__VA_ARGS__)
#define pthread_mutexattr_init(...) page_nothing(__VA_ARGS__)
#define pthread_mutexattr_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_mutexattr_settype(...) page_nothing(__VA_ARGS__)
#define pthread_cond_init(...) page_nothing(__VA_ARGS__)
#define pthread_cond_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_cond_wait(...) page_nothing(__VA_ARGS__)
#define pthread_cond_timedwait(...) page_nothing(__VA_ARGS__)
#define pthread_cond_signal(...) page_nothing(__VA_ARGS__)
#define pthread_cond_broadcast(...) page_nothing(__VA_ARGS__)
#define pthread_condattr_init(...) page_nothing(__VA_ARGS__)
#define pthread_condattr_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_condattr_setclock(...) page_nothing(__VA_ARGS__)
#define pthread_rwlock_init(...) page_nothing(__VA_ARGS__)
#define pthread_rwlock_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_rwlock_rdlock(...) page_nothing(__VA_ARGS__)
#define pthread_rwlock_wrlock(...) page_nothing(__VA_ARGS__)
#define pthread_rwlock_unlock(...) page_nothing(__VA_ARGS__)
#define pthread_rwlockattr_init(...) page_nothing(__VA_ARGS__)
#define pthread_rwlockattr_destroy(...) page_nothing(__VA_ARGS__)
#define pthread_rwlockattr_setkind_np(...) page_nothing(__VA_ARGS__)
#define sigset_t int
#define sigfillset(set) page_nothing(set)
#define SIG_SETMASK 0
#define pthread_sigmask(how, set, before) page_nothing(set, before)
#define pthread_create(thread, attributes, work, context) (page_nothing(thread, attributes, work, context) | NO_THREADS)
#define pthread_join(thread, result) page_nothing(result, thread)
#define pthread_detach(thread) page_nothing("", thread)
#define pthread_kill(thread, signal) page_nothing("", thread, signal)
#define pthread_self() 1UL
#define pthread_equal(one, other) ((one) == (other))

static inline int pthread_once(pthread_once_t *done, void (*work)(void)) {
  if (*done) return 0;
  *done = 1;
  work();
  return 0;
}
