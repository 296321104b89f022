#include "orbit.h"

#include <stdatomic.h>

#include "answer.h"
#include "kapitza/common_threads.h"
#include "kapitza/study_orbit.h"

enum { STACK_BYTES = 8 << 20 };
static const double PAUSE = 0.01; /* s between two calls of `meanwhile` */

typedef struct {
  const kz_scene *scene;
  double *theta, *velocity;
  atomic_bool stops;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  bool done; /* the thread has set what follows */
  kz_status status;
  char *message;
} job;

static kz_status pause_job(void *context) {
  const job *j = context;
  return atomic_load(&j->stops) ? KZ_STOPPED : KZ_OK;
}

/* The thread. Its message is kept apart from those of requests that are read meanwhile. */
static void *orbit_compute(void *context) {
  job *j = context;
  const kz_status status = kz_orbit_record(j->scene, pause_job, j, j->theta, j->velocity);
  pthread_mutex_lock(&j->mutex);
  j->status = status;
  j->message = kz_strdup(status == KZ_FAILED ? kz_message() : "");
  if (status == KZ_FAILED) kz_message_clear();
  j->done = true;
  pthread_cond_signal(&j->changed);
  pthread_mutex_unlock(&j->mutex);
  return NULL;
}

/* Waits until the thread has ended or a pause is over; true in the first case. */
static bool wait_job(job *j) {
  pthread_mutex_lock(&j->mutex);
  if (!j->done) kz_thread_wait(&j->changed, &j->mutex, PAUSE);
  const bool done = j->done;
  pthread_mutex_unlock(&j->mutex);
  return done;
}

/* Until the thread has ended; *ended: the request was ended before, and `ended` has been answered. */
static kz_status orbit_follow(job *j, const kz_request *request, kz_status (*meanwhile)(void *context), void *context,
                              bool *ended) {
  kz_status status = KZ_OK;
  while (!wait_job(j)) {
    if (status == KZ_OK) status = meanwhile(context);
    if (status == KZ_OK && request->ended && !*ended) {
      *ended = true;
      status = kz_answer_ended(request->sequence);
    }
    if (status != KZ_OK || *ended) atomic_store(&j->stops, true);
  }
  return status;
}

kz_status kz_orbit_answer(const kz_request *request, kz_status (*meanwhile)(void *context), void *context) {
  const kz_orbit_plan *plan = request->scene.orbit;
  const int64_t samples = plan->periods * plan->samples_per_period + 1;
  const size_t bytes = (size_t)samples * sizeof(double);
  pthread_t thread;
  bool ended = false;
  KZ_TRY(kz_memory_ask("periods", 3 * bytes));
  KZ_AUTOFREE double *theta = kz_malloc(bytes), *velocity = kz_malloc(bytes);
  job j = {.scene = &request->scene, .theta = theta, .velocity = velocity, .mutex = PTHREAD_MUTEX_INITIALIZER};
  kz_condition_make(&j.changed);
  if (!kz_thread_start(&thread, STACK_BYTES, orbit_compute, &j))
    return kz_fail(KZ_FAILED, "request: orbit: no thread can be started");
  kz_status status = orbit_follow(&j, request, meanwhile, context, &ended);
  pthread_join(thread, NULL);
  if (status == KZ_OK && !ended && j.status != KZ_OK)
    status = kz_fail(j.status, "%s", j.message[0] ? j.message : "request: orbit: failed");
  free(j.message);
  return status != KZ_OK || ended ? status : kz_answer_orbit(request, samples, theta, velocity);
}
