/* Threads and locks. */
#pragma once

#include <pthread.h>

#include "kapitza/common.h"

/* Starts a thread with `stack_bytes` of stack and all signals blocked; false if the system gives no thread. */
bool kz_thread_start(pthread_t *thread, size_t stack_bytes, void *(*work)(void *context), void *context);

/* Makes a condition for kz_thread_wait, on the monotonic clock. */
void kz_condition_make(pthread_cond_t *condition);
/* Waits until `changed` is signalled, or for `seconds`. The caller holds the mutex. */
void kz_thread_wait(pthread_cond_t *changed, pthread_mutex_t *mutex, double seconds);

/* A recursive lock, also for Fortran (src/kernel/vector/locks.f90). Free it with kz_lock_free when nobody holds it. */
typedef struct kz_lock kz_lock;
kz_lock *kz_lock_create(void);
void kz_lock_free(kz_lock *lock);
void kz_lock_take(kz_lock *lock);
void kz_lock_leave(kz_lock *lock);
