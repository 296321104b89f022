/* Labels states by following them in quad precision to an attractor of a given catalogue. Knows nothing of the
 * program's trapping regions: an orbit is captured once it has come within a small circle of an attractor's strobe
 * sequence, in phase, and then, never leaving the circle, has shrunk its distance tenfold. States may have 34 digits.
 *
 * stdin: as catalogue.h says.  stdout, a line per state: label (-1 = captured by none), periods followed. */
#define __STDC_WANT_IEC_60559_TYPES_EXT__ 1 /* strtof128 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "catalogue.h"
#include "../tests/tools/reference.h"
#include "kapitza/kernel.h"

enum { BATCH = 256 };
static const double widest_circle = 1e-2; /* rad */
static const double share_of_gap = 0.2;   /* Share of the smallest distance between two strobe points */
static const double shrinking = 0.1;
static const double at_rest = 1e-8; /* as good as on the attractor */

typedef struct {
  kz_catalogue catalogue;
  double circle; /* radius, rad */
} labeller;

typedef struct {
  int label;
  long periods;
  int expected; /* the strobe point that is due; -1 = outside every circle */
  double entry; /* distance from it when the orbit entered the circle */
} orbit;

/* The circle: small against the gaps, so that no state is near two strobe points. */
static double circle_of(const kz_catalogue *c) {
  double circle = widest_circle;
  for (int i = 0; i < c->n_points; i++)
    for (int j = 0; j < i; j++)
      circle = fmin(circle, share_of_gap * kz_point_distance(c->points[i].theta, c->points[i].velocity, &c->points[j]));
  return circle;
}

static int point_within(const labeller *j, double theta, double velocity) {
  for (int i = 0; i < j->catalogue.n_points; i++)
    if (kz_point_distance(theta, velocity, &j->catalogue.points[i]) < j->circle) return i;
  return -1;
}

/* Takes note of the orbit's strobe state after another period; true where it is settled or out of time. */
static bool reference_label_settled(const labeller *j, orbit *o, double theta, double velocity) {
  double d = o->expected >= 0 ? kz_point_distance(theta, velocity, &j->catalogue.points[o->expected]) : INFINITY;
  if (d > j->circle) {
    o->expected = point_within(j, theta, velocity);
    if (o->expected >= 0) o->entry = kz_point_distance(theta, velocity, &j->catalogue.points[o->expected]);
  } else if (d <= fmax(shrinking * o->entry, at_rest)) {
    o->label = j->catalogue.points[o->expected].attractor;
    return true;
  }
  if (o->expected >= 0) o->expected = j->catalogue.points[o->expected].next;
  if (o->periods == j->catalogue.max_periods) return true;
  o->periods++;
  return false;
}

/* Follows n orbits together, each until it settles: the first `left` ones are still under way. */
static void reference_label_follow(const labeller *j, int n, kz_reference_state *states, orbit **under_way) {
  double theta[BATCH], velocity[BATCH];
  int64_t turns[BATCH];
  for (int left = n; left > 0; kz_reference_advance(&j->catalogue.pendulum, KZ_REFERENCE_STEPS, left, 1, states)) {
    kz_reference_read(left, states, theta, velocity, turns);
    for (int i = left - 1; i >= 0; i--)
      if (reference_label_settled(j, under_way[i], theta[i], velocity[i])) {
        left--;
        states[i] = states[left];
        under_way[i] = under_way[left];
      }
  }
}

/* A number of stdin as a double and what is left of it: it may have more digits than a double. */
static bool read_number(double *high, double *low) {
  char text[128], *end;
  if (scanf("%127s", text) != 1) return false;
  const _Float128 number = strtof128(text, &end);
  *high = (double)number;
  *low = (double)(number - *high);
  return *end == '\0';
}

/* Labels the next batch of stdin; its size, 0 at the end. */
static int label_batch(const labeller *j) {
  static kz_reference_state states[BATCH];
  double theta[BATCH], velocity[BATCH], low[BATCH][2];
  orbit orbits[BATCH], *under_way[BATCH];
  int n = 0;
  while (n < BATCH && read_number(&theta[n], &low[n][0]) && read_number(&velocity[n], &low[n][1])) {
    orbits[n] = (orbit){.label = -1, .expected = -1};
    under_way[n] = &orbits[n];
    n++;
  }
  kz_reference_start(n, theta, velocity, low[0], states);
  reference_label_follow(j, n, states, under_way);
  for (int i = 0; i < n; i++) printf("%d %ld\n", orbits[i].label, orbits[i].periods);
  return n;
}

int main(void) {
  labeller j;
  if (!kz_catalogue_read(stdin, &j.catalogue)) {
    fputs("reference_label: error: stdin: not a catalogue\n", stderr);
    kz_catalogue_free(&j.catalogue);
    return 2;
  }
  j.circle = circle_of(&j.catalogue);
  while (label_batch(&j) > 0) continue;
  kz_catalogue_free(&j.catalogue);
  return fflush(stdout) || ferror(stdout) ? 1 : 0;
}
