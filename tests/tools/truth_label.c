/* Labels states by following them in quad precision to an attractor of a given catalogue. Knows nothing of the program's
 * trapping regions: an orbit is captured once it has come within a small circle of an attractor's strobe sequence, in phase,
 * and then, never leaving the circle, has shrunk its distance tenfold.
 *
 * stdin, text:  k beta m / max_periods / number of attractors / per attractor: period, then period times theta velocity /
 *               any number of states: theta velocity.  stdout, a line per state: label (-1 = captured by none), periods. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "kapitza/truth.h"

enum { BATCH = 256 };
static const double two_pi = 6.28318530717958647692;
static const double widest_circle = 1e-2; /* rad */
static const double share_of_gap = 0.2;   /* of the smallest distance between two strobe points */
static const double shrinking = 0.1;

typedef struct {
  double theta, velocity;
  int attractor, next; /* whose strobe point, and the index of the one that follows */
} strobe_point;

typedef struct {
  kz_pendulum pendulum;
  long max_periods;
  int n_points;
  strobe_point *points;
  double circle;
} catalogue;

typedef struct {
  int label;
  long periods;
  int expected; /* the strobe point that is due; -1 = outside every circle */
  double entry; /* distance from it when the orbit entered the circle */
} orbit;

static double distance(double theta, double velocity, const strobe_point *point)
{
  return hypot(remainder(theta - point->theta, two_pi), velocity - point->velocity);
}

static bool read_attractor(catalogue *c, int attractor)
{
  int period;
  if (scanf("%d", &period) != 1 || period < 1) return false;
  strobe_point *points = realloc(c->points, (size_t)(c->n_points + period) * sizeof *points);
  if (!points) return false;
  c->points = points;
  for (int phase = 0; phase < period; phase++) {
    strobe_point *point = &points[c->n_points + phase];
    if (scanf("%lf %lf", &point->theta, &point->velocity) != 2) return false;
    point->attractor = attractor;
    point->next = c->n_points + (phase + 1) % period;
  }
  c->n_points += period;
  return true;
}

static bool read_catalogue(catalogue *c)
{
  int n_attractors;
  if (scanf("%lf %lf %lf", &c->pendulum.k, &c->pendulum.beta, &c->pendulum.m) != 3) return false;
  if (scanf("%ld %d", &c->max_periods, &n_attractors) != 2) return false;
  for (int attractor = 0; attractor < n_attractors; attractor++)
    if (!read_attractor(c, attractor)) return false;
  return true;
}

/* The circle: small against the gaps, so that no state is near two strobe points. */
static double circle_of(const catalogue *c)
{
  double circle = widest_circle;
  for (int i = 0; i < c->n_points; i++)
    for (int j = 0; j < i; j++)
      circle = fmin(circle, share_of_gap * distance(c->points[i].theta, c->points[i].velocity, &c->points[j]));
  return circle;
}

static int point_within(const catalogue *c, double theta, double velocity)
{
  for (int i = 0; i < c->n_points; i++)
    if (distance(theta, velocity, &c->points[i]) < c->circle) return i;
  return -1;
}

/* Takes note of the orbit's strobe state after another period; true where it is settled or out of time. */
static bool settled(const catalogue *c, orbit *o, double theta, double velocity)
{
  double d = o->expected >= 0 ? distance(theta, velocity, &c->points[o->expected]) : INFINITY;
  if (d > c->circle) {
    o->expected = point_within(c, theta, velocity);
    if (o->expected >= 0) o->entry = distance(theta, velocity, &c->points[o->expected]);
  } else if (d <= shrinking * o->entry) {
    o->label = c->points[o->expected].attractor;
    return true;
  }
  if (o->expected >= 0) o->expected = c->points[o->expected].next;
  return o->periods++ == c->max_periods;
}

/* Follows n orbits together, each until it settles: the first `left` ones are still under way. */
static void follow(const catalogue *c, int n, kz_truth_state *states, orbit **under_way)
{
  double theta[BATCH], velocity[BATCH];
  int64_t turns[BATCH];
  for (int left = n; left > 0; kz_truth_advance(&c->pendulum, KZ_TRUTH_STEPS, left, 1, states)) {
    kz_truth_read(left, states, theta, velocity, turns);
    for (int i = left - 1; i >= 0; i--)
      if (settled(c, under_way[i], theta[i], velocity[i])) {
        left--;
        states[i] = states[left];
        under_way[i] = under_way[left];
      }
  }
}

/* Labels the next batch of stdin; its size, 0 at the end. */
static int label_batch(const catalogue *c)
{
  static kz_truth_state states[BATCH];
  double theta[BATCH], velocity[BATCH];
  orbit orbits[BATCH], *under_way[BATCH];
  int n = 0;
  while (n < BATCH && scanf("%lf %lf", &theta[n], &velocity[n]) == 2) {
    orbits[n] = (orbit){.label = -1, .expected = -1};
    under_way[n] = &orbits[n];
    n++;
  }
  kz_truth_start(n, theta, velocity, states);
  follow(c, n, states, under_way);
  for (int i = 0; i < n; i++) printf("%d %ld\n", orbits[i].label, orbits[i].periods);
  return n;
}

int main(void)
{
  catalogue c = {0};
  if (!read_catalogue(&c)) {
    fputs("truth_label: error: stdin: not a catalogue\n", stderr);
    free(c.points);
    return 2;
  }
  c.circle = circle_of(&c);
  while (label_batch(&c) > 0) continue;
  free(c.points);
  return fflush(stdout) || ferror(stdout) ? 1 : 0;
}
