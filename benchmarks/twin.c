/* The textbook program's SIMD twin: the same RK4 and the same capture, many orbits in lanes, the drive from a table,
 * the sine of the vector library (compile with -ffast-math), a lane refilled as soon as its orbit is captured. */
#include <math.h>

#include "labels.h"

enum { LANES = 64 };
static const double two_pi = 6.28318530717958647692;

typedef struct {
  double theta[LANES], velocity[LANES];
  int near[LANES], expected[LANES], running[LANES];
  long cell[LANES], age[LANES]; /* cell -1: the lane is idle */
} tile;

/* k - m cos t at the 2 STEPS + 1 half steps of a period. */
static void twin_tabulate(const kz_pendulum *p, double *drive) {
  for (int i = 0; i <= 2 * STEPS; i++) drive[i] = p->k - p->m * cos(two_pi * i / (2 * STEPS));
}

static void one_period(double beta, const double *drive, double *restrict theta, double *restrict velocity) {
  const double h = two_pi / STEPS;
  for (int step = 0; step < STEPS; step++) {
    const double d1 = drive[2 * step], d2 = drive[2 * step + 1], d4 = drive[2 * step + 2];
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      double x = theta[i], v = velocity[i];
      double a1 = -beta * v - d1 * sin(x);
      double v2 = v + h / 2 * a1, a2 = -beta * v2 - d2 * sin(x + h / 2 * v);
      double v3 = v + h / 2 * a2, a3 = -beta * v3 - d2 * sin(x + h / 2 * v2);
      double v4 = v + h * a3, a4 = -beta * v4 - d4 * sin(x + h * v3);
      theta[i] = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      velocity[i] = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }
}

/* Wraps every lane and finds the strobe point it is near, -1 = none. */
static void twin_look(const kz_catalogue *c, tile *t) {
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    t->theta[i] -= two_pi * rint(t->theta[i] / two_pi);
    t->near[i] = -1;
  }
  for (int j = 0; j < c->n_points; j++) {
    const double theta = c->points[j].theta, velocity = c->points[j].velocity;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      double x = t->theta[i] - theta, v = t->velocity[i] - velocity;
      x -= two_pi * rint(x / two_pi);
      if (x * x + v * v < capture_circle * capture_circle) t->near[i] = j;
    }
  }
}

/* The lane's label once it is captured, -1 once it is too old, -2 while it goes on. */
static int label_of(const kz_catalogue *c, tile *t, int i) {
  int near = t->near[i];
  t->running[i] = near < 0 ? 0 : near == t->expected[i] ? t->running[i] + 1 : 1;
  t->expected[i] = near < 0 ? -1 : c->points[near].next;
  if (t->running[i] == RUNNING) return c->points[near].attractor;
  return t->age[i]++ == c->max_periods ? -1 : -2;
}

long label_states(const kz_catalogue *catalogue, long n, const double *theta, const double *velocity, int *labels) {
  double drive[2 * STEPS + 1];
  static tile t;
  long next = 0, left = n, periods = 0;
  twin_tabulate(&catalogue->pendulum, drive);
  for (int i = 0; i < LANES; i++) t.cell[i] = -1;
  while (left > 0) {
    for (int i = 0; i < LANES && next < n; i++) {
      if (t.cell[i] >= 0) continue;
      t.cell[i] = next;
      t.theta[i] = theta[next];
      t.velocity[i] = velocity[next++];
      t.expected[i] = -1;
      t.running[i] = 0;
      t.age[i] = 0;
    }
    twin_look(catalogue, &t);
    for (int i = 0; i < LANES; i++) {
      if (t.cell[i] < 0) continue;
      int label = label_of(catalogue, &t, i);
      if (label == -2) continue;
      labels[t.cell[i]] = label;
      t.cell[i] = -1;
      left--;
    }
    one_period(catalogue->pendulum.beta, drive, t.theta, t.velocity);
    periods += LANES;
  }
  return periods;
}
