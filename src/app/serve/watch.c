#include "watch.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

enum { GRACE = 1 /* seconds in which the program ends by itself */ };

/* A pipe without a reader says so without being asked; a file never does. */
static void *watch(void *unused) {
  struct pollfd output = {.fd = STDOUT_FILENO};
  (void)unused;
  while (poll(&output, 1, -1) < 0 && errno == EINTR) continue;
  sleep(GRACE);
  _exit(0);
}

kz_status kz_output_watch(void) {
  pthread_t thread;
  const int error = pthread_create(&thread, NULL, watch, NULL);
  if (error) return kz_fail(KZ_FAILED, "serve: no thread can be started: %s", strerror(error));
  pthread_detach(thread);
  return KZ_OK;
}
