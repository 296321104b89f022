/* Discretised action: theta on a grid, fourth-order differences, an exact Hessian with nine diagonals. */
#include "kapitza/kernel_paths.h"

enum {
  BAND = 4,             /* diagonals of the Hessian on each side */
  FIXED = 4,            /* points at each end that stay */
  MAX_ITERATIONS = 150, /* Newton iterations */
  PATIENCE = 6,         /* iterations after which a search is given up that leads to more than `most` */
  MAX_SHIFTS = 60       /* shifts of the Hessian before a step is given up */
};
/* Relative decrease of the action at which the search ends; decreases like the last one that are foreseen; first shift
 * of the Hessian, and the smallest. */
static const double ENOUGH = 1e-7, FORESEEN = 10, FIRST_SHIFT = 1e-3, LEAST_SHIFT = 1e-12;

typedef struct {
  int64_t n; /* intervals */
  int32_t samples;
  double h, beta;
  double (*pull)[2]; /* [n + 1] the force at each point of the last action_of, and its derivative by the angle */
  double second[5], first[5]; /* weights of the differences */
  const double (*force)[3];
} grid;

typedef struct {
  int64_t n; /* free points */
  double (*hessian)[BAND + 1], (*factor)[BAND + 1], *gradient, *step;
} newton;

static grid grid_of(const kz_pendulum *pendulum, int64_t n, int32_t samples, const double (*force)[3]) {
  static const double SECOND[5] = {-1, 16, -30, 16, -1}, FIRST[5] = {1, -8, 0, 8, -1};
  grid g = {.n = n * samples, .samples = samples, .h = 2 * M_PI / samples, .beta = pendulum->beta, .force = force};
  for (int i = 0; i < 5; i++) {
    g.second[i] = SECOND[i] / (12 * g.h * g.h);
    g.first[i] = FIRST[i] / (12 * g.h);
  }
  return g;
}

static double relax_difference(const double weights[5], const double *x) {
  double sum = 0;
  for (int i = 0; i < 5; i++) sum += weights[i] * x[i - 2];
  return sum;
}

/* The torque u at every point where it is defined; returns the action. */
static double action_of(const grid *g, const double *x, double *u) {
  double sum = 0;
  for (int64_t i = 2; i <= g->n - 2; i++) {
    const double *f = g->force[i % g->samples];
    const double s = sin(x[i]), c = cos(x[i]);
    g->pull[i][0] = f[0] * s - f[1] * c;
    g->pull[i][1] = f[0] * c + f[1] * s;
    u[i] = relax_difference(g->second, x + i) + g->beta * relax_difference(g->first, x + i) + g->pull[i][0] - f[2];
    sum += u[i] * u[i];
  }
  return sum * g->h / (4 * g->beta);
}

/* Gradient and Hessian of half the sum of u^2 at the point of the last action_of. */
static void relax_linearise(const grid *g, const double *u, newton *at) {
  double weight[5];
  for (int p = 0; p < 5; p++) weight[p] = g->second[p] + g->beta * g->first[p];
  for (int64_t a = 0; a < at->n; a++) { /* point a + FIXED acts on u at two points on each side */
    const int64_t i = a + FIXED;
    double sum = 0, row[BAND + 1] = {0};
    for (int e = -2; e <= 2; e++) { /* u at i + e has the weight of place 2 - e of this point */
      const double own = weight[2 - e] + (e == 0 ? g->pull[i][1] : 0);
      sum += own * u[i + e];
      for (int w = 0; w <= 2 - e; w++) /* point i - w has place 2 - e - w there */
        row[w] += own * (weight[2 - e - w] + (w == -e ? g->pull[i + e][1] : 0));
    }
    at->gradient[a] = sum;
    row[0] -= u[i] * g->pull[i][0];
    memcpy(at->hessian[a], row, sizeof row);
  }
}

/* Cholesky's factor of the Hessian + shift; false where it is not positive. */
static bool relax_factorise(newton *at, double shift) {
  for (int64_t a = 0; a < at->n; a++) {
    const int most = a < BAND ? (int)a : BAND;
    for (int w = most; w >= 0; w--) {
      double sum = at->hessian[a][w] + (w == 0 ? shift : 0);
      for (int e = most; e > w; e--) sum -= at->factor[a][e] * at->factor[a - w][e - w];
      if (w == 0 && !(sum > 0)) return false;
      at->factor[a][w] = w == 0 ? 1 / sqrt(sum) : sum * at->factor[a - w][0];
    }
  }
  return true;
}

static void relax_solve(newton *at) {
  for (int64_t a = 0; a < at->n; a++) {
    double sum = -at->gradient[a];
    for (int w = 1; w <= BAND && w <= a; w++) sum -= at->factor[a][w] * at->step[a - w];
    at->step[a] = sum * at->factor[a][0];
  }
  for (int64_t a = at->n - 1; a >= 0; a--) {
    double sum = at->step[a];
    for (int w = 1; w <= BAND && a + w < at->n; w++) sum -= at->factor[a + w][w] * at->step[a + w];
    at->step[a] = sum * at->factor[a][0];
  }
}

/* Takes one step that does not raise the action; false if no shift gives one. `next` has the new point and torque. */
static bool relax_descend(const grid *g, newton *at, const double *x, double *shift, double *action, double *next,
                          double *torque) {
  for (int attempt = 0; attempt < MAX_SHIFTS; attempt++) {
    if (relax_factorise(at, *shift)) {
      relax_solve(at);
      memcpy(next, x, (size_t)(g->n + 1) * sizeof *next);
      for (int64_t a = 0; a < at->n; a++) next[a + FIXED] += at->step[a];
      const double then = action_of(g, next, torque);
      if (then < *action * (1 + 1e-14)) {
        *action = then;
        return true;
      }
    }
    *shift = *shift < LEAST_SHIFT ? LEAST_SHIFT : *shift * 8;
  }
  return false;
}

static double relax_step(const grid *g, newton *at, double most, double *x, double *u, double *next, double *torque) {
  double shift = FIRST_SHIFT, action = action_of(g, x, u);
  for (int i = 0; i < MAX_ITERATIONS; i++) {
    const double before = action;
    relax_linearise(g, u, at);
    if (!relax_descend(g, at, x, &shift, &action, next, torque)) return action;
    memcpy(x, next, (size_t)(g->n + 1) * sizeof *x);
    memcpy(u, torque, (size_t)(g->n + 1) * sizeof *u);
    shift *= 0.15;
    if (before - action < ENOUGH * action) return action;
    if (i >= PATIENCE && action - FORESEEN * (before - action) > most) return INFINITY;
  }
  return action;
}

/* States at the strobes: p2 = u / (2 beta), p1 = beta p2 - p2'. */
static void read_nodes(const grid *g, const double *x, const double *u, double *node) {
  for (int64_t i = 0; i <= g->n; i += g->samples) {
    const int64_t at = i < FIXED ? FIXED : i > g->n - FIXED ? g->n - FIXED : i;
    double *z = node + 4 * (i / g->samples);
    z[0] = x[i];
    z[1] = relax_difference(g->first, x + (i < 2 ? 2 : i > g->n - 2 ? g->n - 2 : i));
    z[3] = u[at] / (2 * g->beta);
    z[2] = g->beta * z[3] - relax_difference(g->first, u + at) / (2 * g->beta);
  }
}

double kz_path_relax(const kz_pendulum *pendulum, int64_t n, int32_t samples, double most, double *theta,
                     double *node) {
  const size_t points = (size_t)(n * samples + 1);
  KZ_AUTOFREE double (*force)[3] = kz_malloc((size_t)samples * sizeof *force);
  KZ_AUTOFREE double *memory = kz_calloc((3 + 2 * (BAND + 1) + 4) * points, sizeof *memory);
  double *u = memory, *next = u + points, *torque = next + points, *hessian = torque + points,
         *factor = hessian + (BAND + 1) * points, *gradient = factor + (BAND + 1) * points;
  newton at = {.n = (int64_t)points - 2 * FIXED,
               .hessian = (double (*)[BAND + 1]) hessian,
               .factor = (double (*)[BAND + 1]) factor,
               .gradient = gradient,
               .step = gradient + points};
  kz_path_forces(pendulum, samples, 0, force[0]);
  grid g = grid_of(pendulum, n, samples, (const double (*)[3])force);
  g.pull = (double (*)[2])(gradient + 2 * points);
  const double action = relax_step(&g, &at, most, theta, u, next, torque);
  read_nodes(&g, theta, u, node);
  return isfinite(action) ? action : INFINITY;
}
