/* How long a run would take, from samples of its work. A child process times them, and is stopped where they take long themselves. */
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app.h"
#include "kapitza/study.h"

/* s of processor time for the samples. */
enum { PATIENCE = 15 };

/* s: starting MPI and writing a file, beyond what this process has taken so far. */
static const double STARTING = 0.02;

/* The message of the child after each study. */
typedef struct {
  double seconds; /* of the studies so far */
  kz_status status;
  bool all;
} told;

static kz_status measure_next(const kz_scene *scene, int study, double *seconds) {
  double some = 0;
  if (!kz_study_is_wanted(&kz_studies[study], scene)) return KZ_OK;
  KZ_TRY(kz_studies[study].measure(scene, &some));
  *seconds += some;
  return KZ_OK;
}

static void measure_as_child(const kz_scene *scene, int pipe) {
  const struct rlimit time = {PATIENCE, PATIENCE}, no_core = {0, 0};
  told t = {0};
  if (setrlimit(RLIMIT_CPU, &time) != 0 || setrlimit(RLIMIT_CORE, &no_core) != 0) _exit(1);
  for (int i = 0; i < kz_study_count && t.status == KZ_OK; i++) {
    t.status = measure_next(scene, i, &t.seconds);
    t.all = t.status != KZ_OK || i == kz_study_count - 1;
    if (write(pipe, &t, sizeof t) != sizeof t) _exit(1);
  }
  _exit(0);
}

/* The last message of the child. */
static told hear(pid_t child, int pipe) {
  told t, last = {0};
  while (read(pipe, &t, sizeof t) == sizeof t) last = t;
  close(pipe);
  waitpid(child, NULL, 0);
  return last;
}

kz_status kz_estimate_time(const kz_scene *scene, kz_estimate *estimate) {
  int ends[2];
  *estimate = (kz_estimate){STARTING + kz_processor_clock(), true};
  if (pipe(ends) != 0) return kz_fail(KZ_FAILED, "no pipe to a process that times samples");
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    measure_as_child(scene, ends[1]);
  }
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    return kz_fail(KZ_FAILED, "no process that times samples");
  }
  const told t = hear(child, ends[0]);
  for (int i = 0; t.status != KZ_OK && i < kz_study_count; i++) /* again, for the message */
    KZ_TRY(measure_next(scene, i, &estimate->seconds));
  estimate->is_whole = t.all;
  estimate->seconds += t.all || t.seconds > PATIENCE ? t.seconds : PATIENCE;
  return KZ_OK;
}
