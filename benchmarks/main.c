/* Reads a catalogue and states (catalogue.h), labels them, and prints "seconds periods", then a label per line. Reading
 * and printing are not timed. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "labels.h"

static double *states; /* theta, velocity of each, as read */
static long n_states;

static bool read_states(void) {
  long room = 0;
  double theta, velocity;
  while (scanf("%lf %lf", &theta, &velocity) == 2) {
    if (n_states == room) {
      room = 2 * room + 1024;
      double *more = realloc(states, (size_t)room * 2 * sizeof *more);
      if (!more) return false;
      states = more;
    }
    states[2 * n_states] = theta;
    states[2 * n_states++ + 1] = velocity;
  }
  return n_states > 0;
}

static double main_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int label_all(const kz_catalogue *catalogue) {
  size_t n = (size_t)n_states;
  double *theta = malloc(2 * n * sizeof *theta), *velocity = theta + n;
  int *labels = malloc(n * sizeof *labels);
  if (theta && labels) {
    for (size_t i = 0; i < n; i++) {
      theta[i] = states[2 * i];
      velocity[i] = states[2 * i + 1];
    }
    double start = main_now();
    long periods = label_states(catalogue, n_states, theta, velocity, labels);
    printf("%.9f %ld\n", main_now() - start, periods);
    for (size_t i = 0; i < n; i++) printf("%d\n", labels[i]);
  }
  int status = theta && labels ? 0 : 1;
  free(theta);
  free(labels);
  return status;
}

int main(void) {
  kz_catalogue catalogue;
  int status = 2;
  if (kz_catalogue_read(stdin, &catalogue) && read_states()) status = label_all(&catalogue);
  if (status == 2) fputs("error: stdin: not a catalogue and states\n", stderr);
  kz_catalogue_free(&catalogue);
  free(states);
  return fflush(stdout) || ferror(stdout) ? 1 : status;
}
