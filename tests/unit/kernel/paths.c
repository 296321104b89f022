/* Paths of least action: closed forms, the linear oscillator, the exactness of the flow. */
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/kernel_paths.h"

static const double PI = 3.14159265358979323846;

static kz_hamilton *flow_of(const kz_pendulum *pendulum, int32_t steps) {
  const kz_pendulum with_derivatives[3] = {*pendulum, {.k = 1}, {.m = 1}};
  return kz_hamilton_create(with_derivatives, steps);
}

/* A blend of two angles about the middle of n periods, relaxed and polished. */
static bool paths_find(const kz_hamilton *flow, const kz_pendulum *pendulum, const kz_path_end *from,
                       const kz_path_end *to, int64_t n, int32_t samples, kz_path *path) {
  double *theta = malloc((size_t)(n * samples + 1) * sizeof *theta);
  *path = (kz_path){.n = n, .node = malloc((size_t)(4 * (n + 1)) * sizeof(double))};
  for (int64_t i = 0; i <= n * samples; i++) {
    const double t = fmin(1, fmax(0, ((double)i / samples - 0.5 * (double)n) / 8 + 0.5));
    theta[i] = from->state[0] + (to->state[0] - from->state[0]) * t * t * t * (10 - 15 * t + 6 * t * t);
  }
  const double action = kz_path_relax(pendulum, n, samples, INFINITY, theta, path->node);
  free(theta);
  return isfinite(action) && kz_path_polish(flow, from, to, path);
}

/* Without a drive the least torque out of the hanging state takes the pendulum over the top along the reversed decay: 2
 * k, for any damping. */
TEST(the_way_over_the_top_costs_twice_the_gravity) {
  static const double BETA[] = {1.0 / 55, 0.1, 0.5};
  for (int i = 0; i < 3; i++) {
    const kz_pendulum pendulum = {1.0 / 121, BETA[i], 0};
    kz_hamilton *flow = flow_of(&pendulum, 72);
    kz_path_end from, to;
    kz_path path;
    assert_true(kz_path_end_find(flow, 1, true, 0, 0, &from) && kz_path_end_find(flow, 1, false, PI, 0, &to));
    assert_true(paths_find(flow, &pendulum, &from, &to, 120, 24, &path));
    assert_true(fabs(path.action / (2 * pendulum.k) - 1) < 1e-6 && path.iterations <= 6);
    const int64_t more[2] = {BETA[i] < 0.05 ? 250 : 120, 60};
    kz_path_lengthen(flow, &from, &to, more, &path);
    assert_true(kz_path_polish(flow, &from, &to, &path));
    assert_true(fabs(path.action / (2 * pendulum.k) - 1) < 1e-12);
    assert_true(fabs(path.slope[0] - 2) < 1e-9 && fabs(path.slope[2]) < 1e-9);
    free(path.node);
    kz_hamilton_free(flow);
  }
}

/* The inverted state at epsilon = 0.3 through the wide 1-nodding: longer paths, and finer grids and steps, give the
 * same action; its derivatives are those of differences. */
static double driven_barrier(double k, double beta, double m, int64_t n, int32_t samples, int32_t steps,
                             double slope[3]) {
  const kz_pendulum pendulum = {k, beta, m};
  kz_hamilton *flow = flow_of(&pendulum, steps);
  kz_path_end from, to;
  kz_path path;
  assert_true(kz_path_end_find(flow, 1, true, PI, 0, &from));
  assert_true(kz_path_end_find(flow, 1, false, 1.473807, 0.0, &to) ||
              kz_path_end_find(flow, 1, false, -1.473807, 0.0, &to));
  assert_true(paths_find(flow, &pendulum, &from, &to, n, samples, &path));
  const int64_t more[2] = {250, 5};
  kz_path_lengthen(flow, &from, &to, more, &path);
  assert_true(kz_path_polish(flow, &from, &to, &path));
  if (slope) memcpy(slope, path.slope, sizeof path.slope);
  free(path.node);
  kz_hamilton_free(flow);
  return path.action;
}

TEST(length_grid_and_steps_do_not_matter) {
  const double k = 1.0 / 121, beta = 1.0 / 55, m = 0.3, h = 1e-4;
  double slope[3];
  const double action = driven_barrier(k, beta, m, 100, 24, 72, slope);
  assert_true(fabs(driven_barrier(k, beta, m, 200, 24, 72, NULL) - action) < 1e-9 * action);
  assert_true(fabs(driven_barrier(k, beta, m, 100, 48, 144, NULL) - action) < 1e-9 * action);
  const double by_m =
      (driven_barrier(k, beta, m + h, 100, 24, 72, NULL) - driven_barrier(k, beta, m - h, 100, 24, 72, NULL)) / (2 * h);
  const double by_beta =
      (driven_barrier(k, beta + h, m, 100, 24, 72, NULL) - driven_barrier(k, beta - h, m, 100, 24, 72, NULL)) / (2 * h);
  assert_true(fabs(slope[1] - by_m) < 1e-6 && fabs(slope[2] - by_beta) < 1e-4);
}

/* Near a stable rest, X of the unstable plane is the covariance of weak noise: of a linear oscillator that of
 * Lyapunov's equation, T/k and T. */
TEST(the_unstable_plane_is_the_covariance_of_noise) {
  const kz_pendulum pendulum = {0.3, 0.1, 0};
  kz_hamilton *flow = flow_of(&pendulum, 96);
  kz_path_end end;
  assert_true(kz_path_end_find(flow, 1, true, 0.01, 0, &end));
  assert_true(fabs(end.covariance[0] * pendulum.k / 2 - 0.5) < 1e-12 && fabs(end.covariance[2] - 1) < 1e-12 &&
              fabs(end.covariance[1]) < 1e-12);
  kz_hamilton_free(flow);
}

/* Every drive: gravity, a tilted pivot with harmonics, and torques. */
TEST(the_flow_is_right_to_1e12_and_symplectic) {
  const kz_pendulum pendulums[] = {{1.0 / 121, 1.0 / 55, 0.3},
                                   {.k = 0.2,
                                    .beta = 0.1,
                                    .m = 0.5,
                                    .torque = 0.05,
                                    .torque_amplitude = 0.1,
                                    .vertical = {{0, 0.1}, {0.2, 0}},
                                    .horizontal = {{0.1, 0.2}, {0, 0.05}},
                                    .harmonics = 2,
                                    .unmirrored = 1}};
  const double start[4] = {2.6, 0.3, 0.02, 0.03};
  for (int p = 0; p < 2; p++) {
    double state[2][4], tangent[2][16], varied[2][4];
    for (int i = 0; i < 2; i++) {
      kz_hamilton *flow = flow_of(pendulums + p, 72 << i);
      memcpy(state[i], start, sizeof start);
      kz_hamilton_advance(flow, 1, state[i], 1, tangent[i], 0, NULL);
      for (int side = 0; side < 2 && i == 0; side++) {
        memcpy(varied[side], start, sizeof start);
        varied[side][0] += side ? 1e-5 : -1e-5;
        kz_hamilton_advance(flow, 1, varied[side], 0, NULL, 0, NULL);
      }
      kz_hamilton_free(flow);
    }
    for (int c = 0; c < 4; c++) {
      assert_true(fabs(state[0][c] - state[1][c]) < 1e-12);
      assert_true(fabs((varied[1][c] - varied[0][c]) / 2e-5 - tangent[0][4 * c]) < 1e-6);
    }
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        const double *t = tangent[0],
                     form = t[i] * t[8 + j] + t[4 + i] * t[12 + j] - t[8 + i] * t[j] - t[12 + i] * t[4 + j];
        assert_true(fabs(form - (j == i + 2) + (i == j + 2)) < 1e-12);
      }
  }
}

/* The velocity of a pendulum without a drive has the variance T, whatever the step. */
TEST(noise_gives_its_temperature) {
  const kz_pendulum pendulum = {1.0 / 121, 0.5, 0};
  const double temperature = 1e-3;
  kz_walker *walker = kz_walker_create(&pendulum, temperature, 24);
  double theta = 0, velocity = 0, sum = 0;
  enum { PERIODS = 400000 };
  for (int64_t t = 0; t < PERIODS; t++) {
    kz_walker_advance(walker, 7, (uint64_t)t, &theta, &velocity);
    sum += velocity * velocity;
  }
  kz_walker_free(walker);
  assert_true(fabs(sum / PERIODS / temperature - 1) < 0.008);
}

/* A constant torque tilts the potential: without a drive the barrier is its height, which falls with the power 3/2
 * near the fold where rest and saddle meet. */
TEST(the_barrier_of_a_tilted_pendulum_is_its_potential) {
  const double k = 0.3, angles[] = {1.0, PI / 2 - 0.2, PI / 2 - 0.1};
  double action[3], fold[3];
  for (int i = 0; i < 3; i++) {
    const kz_pendulum pendulum = {.k = k, .beta = 0.1, .torque = k * sin(angles[i]), .unmirrored = 1};
    kz_hamilton *flow = flow_of(&pendulum, 96);
    kz_path_end from, to;
    kz_path path;
    assert_true(kz_path_end_find(flow, 1, true, angles[i], 0, &from));
    assert_true(kz_path_end_find(flow, 1, false, PI - angles[i], 0, &to));
    assert_true(paths_find(flow, &pendulum, &from, &to, 60, 24, &path));
    const int64_t more[2] = {40, 40};
    kz_path_lengthen(flow, &from, &to, more, &path);
    assert_true(kz_path_polish(flow, &from, &to, &path));
    action[i] = path.action;
    fold[i] = 1 - sin(angles[i]);
    const double height = 2 * k * cos(angles[i]) - pendulum.torque * (PI - 2 * angles[i]);
    assert_true(fabs(action[i] / height - 1) < 1e-9);
    free(path.node);
    kz_hamilton_free(flow);
  }
  assert_true(fabs(log(action[2] / action[1]) / log(fold[2] / fold[1]) - 1.5) < 0.01);
}
