/* Drives beyond k - m cos t: the equation of model.h, integrated here by itself, against the reference and the split scheme. */
#include "../../tools/part.h"
#include "../../tools/test.h"

#include <math.h>
#include <string.h>

#include "kapitza/kernel.h"

enum { N = 40, DRIVES = 4 };

static kz_pendulum drive(int which) {
  kz_pendulum p = {.k = 0.05, .beta = 0.1, .m = 0.4};
  if (which == 0) p.harmonics = 2, p.vertical[1][0] = 0.2, p.vertical[1][1] = -0.1;
  if (which == 1)
    p.harmonics = 1, p.unmirrored = 1, p.vertical[0][0] = -0.05, p.horizontal[0][0] = 0.1, p.horizontal[0][1] = 0.07;
  if (which == 2) p.unmirrored = 1, p.torque = 0.1;
  if (which == 3) p.harmonics = 7, p.vertical[2][0] = -0.15, p.vertical[4][0] = 0.1, p.vertical[6][1] = 0.05;
  return p;
}

static long double acceleration(const kz_pendulum *p, long double t, long double theta, long double v) {
  long double a = p->k - p->m * cosl(t), b = 0;
  for (int j = 1; j <= p->harmonics; j++) {
    a -= p->vertical[j - 1][0] * cosl(j * t) + p->vertical[j - 1][1] * sinl(j * t);
    b += p->horizontal[j - 1][0] * cosl(j * t) + p->horizontal[j - 1][1] * sinl(j * t);
  }
  return p->torque - p->beta * v - a * sinl(theta) + b * cosl(theta);
}

/* From t = `from` through `turn` of drive time by Runge and Kutta in long double. */
static void integrate(const kz_pendulum *p, long double from, long double turn, double *theta, double *velocity) {
  enum { STEPS = 4000 };
  long double x = *theta, v = *velocity, h = turn / STEPS;
  for (int i = 0; i < STEPS; i++) {
    const long double t = from + i * h;
    const long double a1 = acceleration(p, t, x, v), v2 = v + h / 2 * a1;
    const long double a2 = acceleration(p, t + h / 2, x + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const long double a3 = acceleration(p, t + h / 2, x + h / 2 * v2, v3), v4 = v + h * a3;
    const long double a4 = acceleration(p, t + h, x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  *theta = (double)x;
  *velocity = (double)v;
}

static void put_starts(double *theta, double *velocity, int64_t *turns) {
  for (int i = 0; i < N; i++)
    theta[i] = fmod(2.399963 * i, 2 * M_PI) - M_PI, velocity[i] = 3 * fmod(0.7548776662 * i, 1) - 1.5, turns[i] = 0;
}

static double between(double a, double b) {
  return fabs(remainder(a - b, 2 * M_PI));
}

TEST(the_equation_is_integrated) {
  for (int which = 0; which < DRIVES; which += PART > 1 ? 2 : 1) {
    const kz_pendulum p = drive(which);
    const kz_numerics fine[2] = {{.scheme = kz_scheme_find("split6"), .steps_per_period = 192},
                                 {.scheme = kz_scheme_find("processed"), .steps_per_period = 150}};
    double theta[N], velocity[N], x[2][N], v[2][N], y[N], w[N];
    int64_t turns[N];
    kz_reference_state states[N];
    put_starts(theta, velocity, turns);
    for (int i = 0; i < 2; i++) {
      memcpy(x[i], theta, sizeof theta), memcpy(v[i], velocity, sizeof velocity);
      kz_flow *flow = kz_flow_create(&p, fine + i);
      kz_advance(flow, N, 1, x[i], v[i], turns);
      kz_flow_free(flow);
    }
    kz_reference_start(N, theta, velocity, NULL, states);
    kz_reference_advance(&p, KZ_REFERENCE_STEPS, N, 1, states);
    kz_reference_read(N, states, y, w, turns);
    for (int i = 0; i < N; i++) {
      integrate(&p, 0, 2 * acosl(-1), theta + i, velocity + i);
      assert_true(between(y[i], theta[i]) < 1e-11 && fabs(w[i] - velocity[i]) < 1e-11);
      for (int j = 0; j < 2; j++) assert_true(between(x[j][i], y[i]) < 1e-11 && fabs(v[j][i] - w[i]) < 1e-11);
    }
  }
}

/* Without a torque and a horizontal drive the mirror image is a motion, to the bit; with them it is none. */
TEST(symmetry_is_told) {
  for (int i = 0; i < (PART > 1 ? 4 : 2 * DRIVES); i += PART > 1 ? 3 : 1) {
    const kz_pendulum p = drive(i / 2);
    const kz_numerics numerics = {.scheme = kz_scheme_find(i % 2 ? "split6" : "processed"), .steps_per_period = 40};
    double x[N], v[N], y[N], w[N];
    int64_t turns[N];
    put_starts(x, v, turns);
    for (int j = 0; j < N; j++) y[j] = -x[j], w[j] = -v[j];
    kz_flow *flow = kz_flow_create(&p, &numerics);
    kz_advance(flow, N, 3, x, v, turns);
    kz_advance(flow, N, 3, y, w, turns);
    kz_flow_free(flow);
    int mirrored = 0;
    for (int j = 0; j < N; j++) mirrored += x[j] == -y[j] && v[j] == -w[j];
    assert_true(kz_is_mirrored(&p) ? mirrored == N : mirrored == 0);
  }
}

/* The tangent map is the derivative, and areas shrink by exp(-2 pi beta). */
TEST(the_tangent_is_the_derivative) {
  const double h = 1e-5;
  for (int i = 0; i < (PART > 1 ? 4 : 2 * DRIVES); i += PART > 1 ? 3 : 1) {
    const kz_pendulum p = drive(i / 2);
    const kz_numerics numerics = {.scheme = kz_scheme_find(i % 2 ? "split6" : "processed"),
                                  .steps_per_period = i % 2 ? 24 : 150};
    kz_flow *flow = kz_flow_create(&p, &numerics);
    double theta = 0.7, velocity = -0.3, matrix[4], x[2] = {0.7 + h, 0.7 - h}, v[2] = {-0.3, -0.3};
    int64_t turns[2] = {0};
    kz_advance_tangent(flow, 1, 1, &theta, &velocity, turns, matrix);
    kz_advance(flow, 2, 1, x, v, turns);
    kz_flow_free(flow);
    assert_true(fabs((x[0] - x[1]) / (2 * h) - matrix[0]) < 1e-7 && fabs((v[0] - v[1]) / (2 * h) - matrix[2]) < 1e-7);
    assert_true(fabs(matrix[0] * matrix[3] - matrix[1] * matrix[2] - exp(-2 * M_PI * p.beta)) < (i % 2 ? 1e-12 : 1e-10));
  }
}
