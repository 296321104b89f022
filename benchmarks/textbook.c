/* The textbook program: classical RK4, one orbit at a time, sine and cosine of libm in every stage (as in 1992). */
#include <math.h>

#include "labels.h"

static const double two_pi = 6.28318530717958647692;

static double textbook_acceleration(const kz_pendulum *p, double t, double theta, double velocity) {
  return -p->beta * velocity - (p->k - p->m * cos(t)) * sin(theta);
}

static void one_period(const kz_pendulum *p, double *theta, double *velocity) {
  const double h = two_pi / STEPS;
  for (int step = 0; step < STEPS; step++) {
    double t = step * h, x = *theta, v = *velocity;
    double v1 = v, a1 = textbook_acceleration(p, t, x, v);
    double v2 = v + h / 2 * a1, a2 = textbook_acceleration(p, t + h / 2, x + h / 2 * v1, v2);
    double v3 = v + h / 2 * a2, a3 = textbook_acceleration(p, t + h / 2, x + h / 2 * v2, v3);
    double v4 = v + h * a3, a4 = textbook_acceleration(p, t + h, x + h * v3, v4);
    *theta = x + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    *velocity = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  *theta = remainder(*theta, two_pi);
}

static int point_near(const kz_catalogue *c, double theta, double velocity) {
  for (int i = 0; i < c->n_points; i++)
    if (kz_point_distance(theta, velocity, &c->points[i]) < capture_circle) return i;
  return -1;
}

static int label_of(const kz_catalogue *c, double theta, double velocity, long *periods) {
  int expected = -1, running = 0;
  for (long period = 0;; period++) {
    int near = point_near(c, theta, velocity);
    running = near < 0 ? 0 : near == expected ? running + 1 : 1;
    if (running == RUNNING) return c->points[near].attractor;
    if (period == c->max_periods) return -1;
    expected = near < 0 ? -1 : c->points[near].next;
    one_period(&c->pendulum, &theta, &velocity);
    ++*periods;
  }
}

long label_states(const kz_catalogue *catalogue, long n, const double *theta, const double *velocity, int *labels) {
  long periods = 0;
  for (long i = 0; i < n; i++) labels[i] = label_of(catalogue, theta[i], velocity[i], &periods);
  return periods;
}
