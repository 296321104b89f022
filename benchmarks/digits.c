/* Orbits of any digits with their neighbourhood, as deep windows follow them: what a period costs under a sine, on a
 * tilted path, under a square wave of seven harmonics, and on a ramp.
 *
 * stdout: for each number of digits of a window's width and each drive a line "row DIGITS DRIVE US RATIO PER_HARMONIC":
 * microseconds of a period, over those of the sine, over those of the sine and the number of harmonics up and across.
 * Processor time, the shortest of five. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "kapitza/kernel.h"
#include "kapitza/model_release.h"

enum { REPEATS = 5, PERIODS = 4, GUARD = 90 /* bits of an orbit below the size of its window */ };

typedef struct {
  const char *name;
  kz_pendulum pendulum;
  kz_release release;
  int harmonics;
} drive;

#define FIG12 .k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3
#define SQUARE(j) (0.3 * 4 / M_PI / (j) * ((j) % 4 == 1 ? 1 : -1))
static const drive drives[] = {
    {"sine", {FIG12}, {0}, 1},
    {"tilted",
     {FIG12, .vertical = {{0.3 * -0.0038053, 0}}, .horizontal = {{0.3 * 0.0871557, 0}}, .harmonics = 1,
      .unmirrored = 1},
     {0},
     2},
    {"square",
     {FIG12, .vertical = {{SQUARE(1) - 0.3, 0}, {0}, {SQUARE(3), 0}, {0}, {SQUARE(5), 0}, {0}, {SQUARE(7), 0}},
      .harmonics = 7},
     {0},
     7},
    {"ramp", {FIG12}, {.periods = 1e6, .damping = 1.0 / 55, .drive = 0.5, .smooth = 1}, 1}};

static double digits_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Microseconds of a period with so many bits; NAN: it cannot be followed. */
static double time_of(const drive *d, int64_t bits) {
  const kz_coordinate start[2] = {{.high = -0.265}, {.high = 1.42}};
  double best = INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    kz_jet jet = {.linear = {{1, 0}, {0, 1}}};
    kz_arbitrary *orbit = kz_arbitrary_create(&d->pendulum, start, bits);
    kz_arbitrary_release(orbit, &d->release);
    const double begun = digits_now();
    for (int period = 0; period < PERIODS; period++)
      if (kz_arbitrary_advance(orbit, bits, 3, &jet) != KZ_OK) return NAN;
    best = fmin(best, digits_now() - begun);
    kz_arbitrary_free(orbit);
  }
  return 1e6 * best / PERIODS;
}

int main(void) {
  static const int digits[] = {20, 50, 100};
  for (size_t i = 0; i < sizeof digits / sizeof *digits; i++) {
    double sine = 0;
    for (size_t j = 0; j < sizeof drives / sizeof *drives; j++) {
      const double us = time_of(drives + j, (int64_t)ceil(digits[i] / log10(2)) + GUARD);
      if (j == 0) sine = us;
      printf("row %d %s %.0f %.2f %.2f\n", digits[i], drives[j].name, us, us / sine, us / sine / drives[j].harmonics);
    }
  }
  return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
