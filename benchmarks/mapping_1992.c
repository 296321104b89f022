/* Interpolated cell mapping as Blackburn, Smith and Groenbech-Jensen (1992) meant it, against RK4 with 100 steps a
 * period: every start is followed for the same number of periods. Prints processor times and their ratio; Sec. IV of
 * the paper says 30 to 50. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum {
  STEPS = 100,
  PERIODS = 300,
  NODES = 500,
  STARTS = 4000,
  CELLS = 1000000 /* Cells of a picture, among which the table's time is shared */
};
static const double K = 1.0 / 121, BETA = 1.0 / 55, M = 0.3, TWO_PI = 6.28318530717958647692, FASTEST = 2;

static double mapping_acceleration(double theta, double velocity, double t) {
  return -BETA * velocity - (K - M * cos(t)) * sin(theta);
}

static void integrate_period(double *theta, double *velocity) {
  const double h = TWO_PI / STEPS;
  for (int i = 0; i < STEPS; i++) {
    const double t = i * h, x = *theta, v = *velocity;
    const double a1 = mapping_acceleration(x, v, t), v2 = v + h / 2 * a1;
    const double a2 = mapping_acceleration(x + h / 2 * v, v2, t + h / 2), v3 = v + h / 2 * a2;
    const double a3 = mapping_acceleration(x + h / 2 * v2, v3, t + h / 2), v4 = v + h * a3;
    *theta = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    *velocity = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + mapping_acceleration(x + h * v3, v4, t + h));
  }
  *theta -= TWO_PI * rint(*theta / TWO_PI);
}

/* Displacement of the angle and new velocity at the nodes of the lattice; the angle is periodic. */
static double (*make_table(void))[2] {
  double (*node)[2] = malloc(sizeof *node * NODES * NODES);
  for (int row = 0; node && row < NODES; row++)
    for (int column = 0; column < NODES; column++) {
      const double before = TWO_PI * column / NODES - TWO_PI / 2;
      double theta = before, velocity = 2 * FASTEST * row / (NODES - 1) - FASTEST;
      integrate_period(&theta, &velocity);
      node[row * NODES + column][0] = theta - before - TWO_PI * rint((theta - before) / TWO_PI);
      node[row * NODES + column][1] = velocity;
    }
  return node;
}

static void map_period(double (*node)[2], double *theta, double *velocity) {
  const double x = (*theta / TWO_PI + 0.5) * NODES;
  const double y = fmin(fmax((*velocity + FASTEST) / (2 * FASTEST), 0), 1) * (NODES - 1);
  const int column = (int)x % NODES, row = y < NODES - 1 ? (int)y : NODES - 2, next = (column + 1) % NODES;
  const double s = x - (int)x, u = y - row;
  const double *a = node[row * NODES + column], *b = node[row * NODES + next], *c = a + 2 * NODES, *d = b + 2 * NODES;
  *theta += (1 - u) * ((1 - s) * a[0] + s * b[0]) + u * ((1 - s) * c[0] + s * d[0]);
  *velocity = (1 - u) * ((1 - s) * a[1] + s * b[1]) + u * ((1 - s) * c[1] + s * d[1]);
  *theta -= TWO_PI * rint(*theta / TWO_PI);
  if (*theta >= TWO_PI / 2) *theta -= TWO_PI;
}

static double seconds_since(clock_t begin) {
  return (double)(clock() - begin) / CLOCKS_PER_SEC;
}

/* Follows the starts; returns the seconds. The sum of all ends keeps the compiler from leaving out the work. */
static double mapping_follow(double (*node)[2], double *sum) {
  const clock_t begin = clock();
  srand(1);
  for (int start = 0; start < STARTS; start++) {
    double theta = TWO_PI * (rand() / (RAND_MAX + 1.0) - 0.5), velocity = 3 * (rand() / (RAND_MAX + 1.0) - 0.5);
    for (int period = 0; period < PERIODS; period++) {
      if (node)
        map_period(node, &theta, &velocity);
      else
        integrate_period(&theta, &velocity);
    }
    *sum += theta + velocity;
  }
  return seconds_since(begin);
}

int main(void) {
  double sum = 0;
  const clock_t begin = clock();
  double (*node)[2] = make_table();
  if (!node) return 1;
  const double table = seconds_since(begin), mapped = mapping_follow(node, &sum),
               integrated = mapping_follow(NULL, &sum);
  const double share = table * STARTS / CELLS;
  printf(
      "RK4 %.2f us, mapping %.3f us a start and %d periods, table %.2f s; integration over mapping %.0f, with the "
      "table's "
      "share of a "
      "million cells %.0f (sum %g)\n",
      1e6 * integrated / STARTS, 1e6 * mapped / STARTS, PERIODS, table, integrated / mapped,
      integrated / (mapped + share), sum);
  free(node);
  return 0;
}
