/* How long a run would take, from samples of its work. A thread times them; where they take long themselves, nobody waits for it. */
#include <stdlib.h>
#include <time.h>

#include "app.h"
#include "kapitza/common_threads.h"
#include "kapitza/study.h"
#include "scene/scene.h"

/* s of processor time for the samples; bytes of stack of the thread. */
enum { PATIENCE = 15, STACK_BYTES = 8 << 20 };

/* s: starting MPI and writing a file, beyond what this process has taken so far. */
static const double STARTING = 0.02;

/* What the thread shares with the one that waits. The last of the two frees it. */
typedef struct {
  kz_scene scene; /* a copy: the thread may outlive the caller's */
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  double seconds; /* of the studies so far */
  kz_status status;
  bool ended, left; /* by the thread; by the one that waits */
} samples;

static void free_samples(samples *s) {
  kz_scene_free(&s->scene);
  free(s);
}

static void *measure(void *context) {
  samples *s = context;
  kz_status status = KZ_OK;
  for (int i = 0; i < kz_study_count && status == KZ_OK; i++) {
    double some = 0;
    if (kz_study_is_wanted(&kz_studies[i], &s->scene)) status = kz_studies[i].measure(&s->scene, &some);
    pthread_mutex_lock(&s->mutex);
    s->seconds += some;
    pthread_mutex_unlock(&s->mutex);
  }
  pthread_mutex_lock(&s->mutex);
  const bool left = s->left;
  s->status = status;
  s->ended = true;
  pthread_cond_signal(&s->changed);
  pthread_mutex_unlock(&s->mutex);
  if (left) free_samples(s);
  return NULL;
}

/* s of processor time that a thread has taken. */
static double time_of(pthread_t thread) {
  clockid_t clock;
  struct timespec taken = {0};
  if (pthread_getcpuclockid(thread, &clock) == 0) clock_gettime(clock, &taken);
  return (double)taken.tv_sec + 1e-9 * (double)taken.tv_nsec;
}

/* Waits for the thread, and leaves it alone once it has taken too long. */
static kz_status wait_for(pthread_t thread, samples *s, kz_estimate *estimate) {
  const double look = 0.05; /* s between two looks at its clock */
  pthread_mutex_lock(&s->mutex);
  while (!s->ended && time_of(thread) < PATIENCE) kz_thread_wait(&s->changed, &s->mutex, look);
  const kz_status status = s->status;
  const bool ended = estimate->is_whole = s->ended;
  estimate->seconds += s->ended || s->seconds > PATIENCE ? s->seconds : PATIENCE;
  s->left = !ended;
  pthread_mutex_unlock(&s->mutex);
  if (!ended) {
    pthread_detach(thread);
    return KZ_OK;
  }
  pthread_join(thread, NULL);
  free_samples(s);
  return status;
}

kz_status kz_estimate_time(const kz_scene *scene, kz_estimate *estimate) {
  samples *s = kz_calloc(1, sizeof *s);
  pthread_t thread;
  *estimate = (kz_estimate){.seconds = STARTING + kz_processor_clock()};
  kz_scene_copy(scene, &s->scene);
  pthread_mutex_init(&s->mutex, NULL);
  pthread_cond_init(&s->changed, NULL);
  if (kz_thread_start(&thread, STACK_BYTES, measure, s)) return wait_for(thread, s, estimate);
  free_samples(s);
  return kz_fail(KZ_FAILED, "no thread that times samples");
}
