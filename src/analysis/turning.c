/* Turning points of a sampled motion. */
#include "kapitza/analysis.h"

enum { NODES = 4, TERMS = 2 * NODES };

static int node_of_term(int term) {
  return term / 2;
}

/* Newton's coefficients on the nodes 0 0 1 1 2 2 3 3 of the polynomial with angles and velocities of four samples. */
static void hermite_coefficients(double step, const double *theta, const double *velocity, double *c) {
  for (int i = 0; i < TERMS; i++) c[i] = theta[node_of_term(i)];
  for (int order = 1; order < TERMS; order++) {
    for (int i = TERMS - 1; i >= order; i--) {
      int distance = node_of_term(i) - node_of_term(i - order);
      c[i] = distance == 0 ? step * velocity[node_of_term(i)] : (c[i] - c[i - 1]) / distance;
    }
  }
}

/* Returns the angle, and its slope, s steps after the first node. */
static double hermite_at(const double *c, double s, double *slope) {
  double value = c[TERMS - 1];
  *slope = 0;
  for (int i = TERMS - 2; i >= 0; i--) {
    *slope = *slope * (s - node_of_term(i)) + value;
    value = value * (s - node_of_term(i)) + c[i];
  }
  return value;
}

/* Returns the root of the slope between two nodes with slopes of different signs, by bisection to the last bit. */
static double slope_root(const double *c, double low, double high) {
  double slope, slope_low;
  hermite_at(c, low, &slope_low);
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
    hermite_at(c, middle, &slope);
    if ((slope < 0) == (slope_low < 0))
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* The turning point between samples i - 1 and i of n. */
static kz_turning_point turning_point_between(int64_t i, int64_t n, double step, const double *theta,
                                              const double *velocity) {
  int64_t first = i - NODES / 2;
  if (first > n - NODES) first = n - NODES;
  if (first < 0) first = 0;
  double c[TERMS], slope;
  hermite_coefficients(step, theta + first, velocity + first, c);
  double s = slope_root(c, (double)(i - 1 - first), (double)(i - first));
  return (kz_turning_point){((double)first + s) * step, hermite_at(c, s, &slope)};
}

int64_t kz_turning_points(int64_t n, double step, const double *theta, const double *velocity,
                          kz_turning_point *found) {
  int64_t count = 0, moving = -1; /* Latest sample with a velocity */
  if (n < NODES) return 0;
  for (int64_t i = 0; i < n; i++) {
    if (velocity[i] == 0) continue;
    bool turned = moving >= 0 && (velocity[i] < 0) != (velocity[moving] < 0);
    if (turned && moving == i - 1) found[count++] = turning_point_between(i, n, step, theta, velocity);
    if (turned && moving < i - 1) found[count++] = (kz_turning_point){(double)(i - 1) * step, theta[i - 1]};
    moving = i;
  }
  return count;
}
