/* Pendulums of the library: made, freed, used by one thread at a time. */
#include <errno.h>
#include <time.h>
#include <unistd.h>

#include "../library.h"
#include "kapitza/study_flutter.h"
#include "kapitza/version.h"

enum { WAIT_NANOSECONDS = 50000000 }; /* between two looks while another thread uses the pendulum */

static _Thread_local struct {
  kapitza_pause ask;
  void *context;
} pause_of_thread;

const char *kapitza_message(void) {
  return kz_message();
}

const char *kapitza_version(void) {
  return KZ_VERSION;
}

void kapitza_free(void *memory) {
  free(memory);
}

void kapitza_set_pause(kapitza_pause pause, void *context) {
  pause_of_thread.ask = pause;
  pause_of_thread.context = context;
}

static kz_status ask_caller(void *context) {
  (void)context;
  return pause_of_thread.ask(pause_of_thread.context) == 0 ? KZ_OK : kz_fail(KZ_STOPPED, "stopped by the caller");
}

kz_pause_fn kz_library_pause(void) {
  return pause_of_thread.ask ? ask_caller : NULL;
}

kapitza_status kz_library_status(kz_status status, const kz_border *border) {
  return status == KZ_FAILED && kz_border_lacked_memory(border) ? KAPITZA_NO_MEMORY : (kapitza_status)status;
}

/* ---- one call at a time ---- */

static kz_status refuse_busy(void) {
  return kz_fail(KZ_REFUSED, "the pendulum was in use when this process was forked; make a new one here");
}

/* After a fork no thread of the parent is here that would leave the lock. */
static kz_status check_process(kapitza_pendulum *p) {
  if (p->process == getpid()) return KZ_OK;
  if (p->busy) return refuse_busy();
  p->process = getpid();
  return KZ_OK;
}

/* Waits for other threads, as long as the caller wants to. *inner: this thread has it, and is between two parts of its
 * work. */
static kz_status pendulum_take(kapitza_pendulum *p, bool *inner) {
  *inner = false;
  KZ_TRY(check_process(p));
  for (;;) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += WAIT_NANOSECONDS;
    if (until.tv_nsec >= 1000000000) {
      until.tv_nsec -= 1000000000;
      until.tv_sec++;
    }
    const int error = pthread_mutex_timedlock(&p->mutex, &until);
    if (error == 0) break;
    if (error == EDEADLK && p->between) {
      *inner = true;
      return KZ_OK;
    }
    if (error == EDEADLK) return kz_fail(KZ_REFUSED, "the pause of a call uses the pendulum of that call");
    if (error != ETIMEDOUT) return kz_fail(KZ_FAILED, "%s", strerror(error));
    if (kz_library_pause()) KZ_TRY(ask_caller(NULL));
  }
  p->busy = 1;
  return KZ_OK;
}

static void pendulum_leave(kapitza_pendulum *p) {
  p->busy = 0;
  pthread_mutex_unlock(&p->mutex);
}

typedef struct {
  kapitza_pendulum *pendulum;
  kz_work_fn work;
  void *context;
} visit;

static kz_status open_pendulum(kapitza_pendulum *p) {
  if (p->opened) return KZ_OK;
  KZ_TRY(kz_scene_open(&p->text, NULL, &p->scene));
  p->engine = kz_engine_create();
  p->flow[0] = p->flow[1] = NULL;
  p->atlas = NULL;
  p->opened = true;
  return KZ_OK;
}

static kz_status carry_out(void *context) {
  const visit *v = context;
  KZ_TRY(open_pendulum(v->pendulum));
  return v->work ? v->work(v->pendulum, v->context) : KZ_OK;
}

kapitza_status kz_library_call(kapitza_pendulum *p, kz_work_fn work, void *context) {
  visit v = {p, work, context};
  bool left = false, inner;
  kz_message_clear();
  kz_status status = pendulum_take(p, &inner);
  if (status != KZ_OK) return (kapitza_status)status;
  p->between = false;
  status = kz_border_call(p->border, kz_library_pause(), NULL, carry_out, &v, &left);
  const kapitza_status told = kz_library_status(status, p->border);
  p->between = inner;
  if (inner) return told; /* the outer call is left too, where this one was */
  if (left) {             /* a call that was left may have half-made caches */
    kz_border_empty(p->border);
    p->opened = false;
  }
  pendulum_leave(p);
  return told;
}

kz_status kz_library_between(kapitza_pendulum *p, kapitza_pause between, void *context) {
  KZ_TRY(kz_border_pause());
  if (!between) return KZ_OK;
  p->between = true;
  const int stops = between(context);
  p->between = false;
  kz_border_leave();
  return stops ? kz_fail(KZ_STOPPED, "stopped by the caller") : KZ_OK;
}

/* ---- memory for the caller ---- */

size_t kz_library_rounded(size_t bytes) {
  return (bytes + 15) / 16 * 16;
}

void *kz_library_part(char **piece, size_t bytes) {
  void *part = *piece;
  *piece += kz_library_rounded(bytes);
  return part;
}

/* ---- made and freed ---- */

static void free_pendulum(kapitza_pendulum *p) {
  kz_border_free(p->border);
  pthread_mutex_destroy(&p->mutex);
  free(p);
}

kz_scene_source kz_library_text(const kapitza_scene *scene) {
  return (kz_scene_source){scene->text, scene->name, scene->n_sets, (char *const *)scene->sets};
}

static char *keep_text(const char *text, char **place) {
  char *kept = strcpy(*place, text);
  *place += strlen(text) + 1;
  return kept;
}

/* A pendulum with a copy of the scene behind it. NULL: there is no memory. */
static kapitza_pendulum *pendulum_with(const kapitza_scene *scene) {
  size_t bytes = strlen(scene->text) + strlen(scene->name) + 2;
  for (int i = 0; i < scene->n_sets; i++) bytes += sizeof(char *) + strlen(scene->sets[i]) + 1;
  kapitza_pendulum *p = kz_border_give(sizeof *p + bytes);
  if (!p) return NULL;
  char **sets = (char **)(p + 1), *place = (char *)(sets + scene->n_sets);
  for (int i = 0; i < scene->n_sets; i++) sets[i] = keep_text(scene->sets[i], &place);
  p->text = (kz_scene_source){keep_text(scene->text, &place), keep_text(scene->name, &place), scene->n_sets, sets};
  return p;
}

static kapitza_status lacks_memory(void) {
  kz_fail(KZ_FAILED, "memory ran out");
  return KAPITZA_NO_MEMORY;
}

kapitza_status kz_library_alone(kz_status (*work)(void *context), void *context) {
  bool left;
  kz_message_clear();
  if (kz_tables_make() != KZ_OK) return KAPITZA_NO_MEMORY;
  kz_border *border = kz_border_create();
  if (!border) return lacks_memory();
  const kapitza_status told =
      kz_library_status(kz_border_call(border, kz_library_pause(), NULL, work, context, &left), border);
  kz_border_free(border);
  return told;
}

kapitza_status kz_library_create(const kapitza_scene *scene, kapitza_pendulum **pendulum) {
  *pendulum = NULL;
  kz_message_clear();
  if (kz_tables_make() != KZ_OK) return KAPITZA_NO_MEMORY;
  kapitza_pendulum *p = pendulum_with(scene);
  kz_border *border = p ? kz_border_create() : NULL;
  if (!border) {
    free(p);
    return lacks_memory();
  }
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ERRORCHECK);
  pthread_mutex_init(&p->mutex, &attributes);
  pthread_mutexattr_destroy(&attributes);
  p->border = border;
  p->process = getpid();
  const kapitza_status status = kz_library_call(p, NULL, NULL);
  if (status == KAPITZA_OK)
    *pendulum = p;
  else
    free_pendulum(p);
  return status;
}

void kapitza_pendulum_free(kapitza_pendulum *pendulum) {
  if (pendulum) free_pendulum(pendulum);
}

kapitza_parameters kz_library_parameters(const kz_parameters *own) {
  return (kapitza_parameters){
      own->pendulum.k,      own->pendulum.beta,   own->pendulum.m,      own->quality_factor,
      own->drive_frequency, own->drive_amplitude, own->pivot_frequency, kz_is_mirrored(&own->pendulum)};
}

static kz_status tell_parameters(kapitza_pendulum *p, void *context) {
  *(kapitza_parameters *)context = kz_library_parameters(&p->scene.parameters);
  return KZ_OK;
}

kapitza_status kapitza_parameters_of(kapitza_pendulum *pendulum, kapitza_parameters *parameters) {
  return kz_library_call(pendulum, tell_parameters, parameters);
}

static kz_status tell_needs(kapitza_pendulum *p, void *context) {
  double *amplitude = context;
  const kz_pendulum *pendulum = &p->scene.parameters.pendulum;
  kz_standing_drives(pendulum, amplitude, amplitude + 1);
  kz_flutter_drives(pendulum, amplitude + 2, amplitude + 3);
  return KZ_OK;
}

kapitza_status kapitza_needs(kapitza_pendulum *pendulum, double amplitude[4]) {
  return kz_library_call(pendulum, tell_needs, amplitude);
}
