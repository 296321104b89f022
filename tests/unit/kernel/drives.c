/* Drives beyond k - m cos t: both splittings against the reference, which verification/drives.c holds against the equation; symmetry; tangents. */
#include "../../tools/part.h"
#include "../../tools/reference.h"
#include "../../tools/test.h"

#include <math.h>

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

static void put_starts(double *theta, double *velocity, int64_t *turns) {
  for (int i = 0; i < N; i++)
    theta[i] = fmod(2.399963 * i, 2 * M_PI) - M_PI, velocity[i] = 3 * fmod(0.7548776662 * i, 1) - 1.5, turns[i] = 0;
}

static double between(double a, double b) {
  return fabs(remainder(a - b, 2 * M_PI));
}

TEST(splittings_agree_with_the_reference) {
  static const char *const schemes[] = {"split6", "processed"};
  static const int32_t steps[] = {192, 150};
  for (int which = 0; which < DRIVES; which += PART > 1 ? 2 : 1) {
    const kz_pendulum p = drive(which);
    double theta[N], velocity[N], x[N], v[N];
    int64_t turns[N];
    kz_reference_state states[N];
    put_starts(theta, velocity, turns);
    kz_reference_start(N, theta, velocity, NULL, states);
    kz_reference_advance(&p, KZ_REFERENCE_STEPS, N, 1, states);
    kz_reference_read(N, states, theta, velocity, turns);
    for (int scheme = 0; scheme < 2; scheme++) {
      const kz_numerics fine = {.scheme = kz_scheme_find(schemes[scheme]), .steps_per_period = steps[scheme]};
      put_starts(x, v, turns);
      kz_flow *flow = kz_flow_create(&p, &fine);
      kz_advance(flow, N, 1, x, v, turns);
      kz_flow_free(flow);
      for (int i = 0; i < N; i++) assert_true(between(x[i], theta[i]) < 1e-11 && fabs(v[i] - velocity[i]) < 1e-11);
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
