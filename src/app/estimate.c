/* How long a run would take: a thread runs the studies, sampled, and writes their result into memory. If it takes too long,
 * the command ends without the estimate. */
#include <stdlib.h>
#include <time.h>

#include "app.h"
#include "kapitza/common_threads.h"
#include "kapitza/study.h"
#include "scene/scene.h"

/* s of processor time: for samples; after which the thread is left alone, since a single tile takes long. Bytes of its stack. */
enum { FOR_SAMPLES = 12, PATIENCE = 14, STACK_BYTES = 8 << 20 };

/* s: starting MPI and writing a file, beyond what this process has taken so far. */
static const double STARTING = 0.02;

/* What the thread shares with the one that waits. The last of the two frees it. */
typedef struct {
  kz_scene scene; /* a copy: the thread may outlive the caller's */
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  double seconds; /* once it has ended */
  kz_status status;
  bool ended, left; /* by the thread; by the one that waits */
} samples;

static void free_samples(samples *s) {
  kz_scene_free(&s->scene);
  free(s);
}

static kz_status run_studies(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_TRY(kz_pendulum_write(&scene->parameters, store));
  for (int i = 0; i < kz_study_count; i++)
    if (kz_study_is_wanted(kz_studies[i], scene)) KZ_TRY(kz_studies[i]->run(scene, run, store, summary));
  return KZ_OK;
}

static void *time_studies(void *context) {
  samples *s = context;
  kz_sampling sample;
  const kz_run run = {.sample = &sample};
  kz_store *store = NULL;
  FILE *summary = fopen("/dev/null", "we");
  kz_sampling_begin(&sample, FOR_SAMPLES);
  kz_status status = summary ? kz_store_create(NULL, kz_groups, &store) : kz_fail(KZ_FAILED, "/dev/null cannot be opened");
  if (status == KZ_OK) status = run_studies(&s->scene, &run, store, summary);
  kz_store_discard(store);
  if (summary) fclose(summary);
  pthread_mutex_lock(&s->mutex);
  const bool left = s->left;
  s->seconds = kz_sampling_seconds(&sample);
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

/* Waits for the thread, and leaves it alone once it has taken too long. What a sample refuses may be due to what it left out: the run refuses
 * it, if it has to. */
static void wait_for(pthread_t thread, samples *s, kz_estimate *estimate) {
  const double look = 0.05; /* s between two looks at its clock */
  pthread_mutex_lock(&s->mutex);
  while (!s->ended && time_of(thread) < PATIENCE) kz_thread_wait(&s->changed, &s->mutex, look);
  const bool ended = s->ended;
  estimate->is_whole = ended && s->status == KZ_OK;
  estimate->seconds += ended ? s->seconds : PATIENCE;
  s->left = !ended;
  pthread_mutex_unlock(&s->mutex);
  if (!ended) {
    pthread_detach(thread);
    return;
  }
  pthread_join(thread, NULL);
  free_samples(s);
}

kz_status kz_estimate_time(const kz_scene *scene, kz_estimate *estimate) {
  samples *s = kz_calloc(1, sizeof *s);
  pthread_t thread;
  *estimate = (kz_estimate){.seconds = STARTING + kz_processor_clock()};
  kz_scene_copy(scene, &s->scene);
  pthread_mutex_init(&s->mutex, NULL);
  pthread_cond_init(&s->changed, NULL);
  if (kz_thread_start(&thread, STACK_BYTES, time_studies, s)) {
    wait_for(thread, s, estimate);
    return KZ_OK;
  }
  free_samples(s);
  return kz_fail(KZ_FAILED, "no thread that times samples");
}
