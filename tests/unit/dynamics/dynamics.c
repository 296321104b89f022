/* Attractors, map table, trapping regions. */
#include "../../tools/test.h"

#include "../../tools/explored.h"
#include "kapitza/dynamics.h"
#include "kapitza/kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The four attractors of Fig. 13, whatever the seed: pairs are exact mirror images, ids do not depend on the search. */
TEST(test_catalogue) {
  kz_dynamics *a = explored_dynamics(0.46, 1, 3), *b = explored_dynamics(0.46, 77, 3);
  int64_t order_a[64], order_b[64], n = kz_dynamics_count(a);
  assert_int_equal(n, 4);
  assert_int_equal(kz_dynamics_count(b), n);
  kz_dynamics_order(a, order_a);
  kz_dynamics_order(b, order_b);
  for (int64_t i = 0; i < n; i++) {
    kz_attractor x, y, z;
    double theta[12], velocity[12], theta2[12], velocity2[12];
    kz_dynamics_attractor(b, order_b[i], &y);
    kz_dynamics_strobe(b, order_b[i], theta2, velocity2);
    kz_dynamics_attractor(a, order_a[i], &x);
    kz_dynamics_strobe(a, order_a[i], theta, velocity);
    assert_int_equal(x.period, y.period);
    assert_int_equal(x.winding, y.winding);
    assert_true(hypot(x.multiplier_re[0], x.multiplier_im[0]) < 1);
    for (int j = 0; j < x.period; j++) {
      assert_true(fabs(theta[j] - theta2[j]) < 1e-9 && fabs(velocity[j] - velocity2[j]) < 1e-9);
      assert_true(theta[j] >= -M_PI && theta[j] < M_PI);
      assert_false(signbit(theta[j]) && theta[j] == 0);
      assert_false(signbit(velocity[j]) && velocity[j] == 0);
    }
    kz_dynamics_attractor(a, x.mirror, &z);
    kz_dynamics_strobe(a, x.mirror, theta2, velocity2);
    assert_int_equal(z.winding, -x.winding);
    assert_int_equal(z.mirror, order_a[i]);
    assert_int_equal(x.symmetric, x.mirror == order_a[i]);
    for (int j = 0; j < x.period; j++) {
      int found = 0;
      for (int k = 0; k < x.period; k++)
        found += velocity2[k] == -velocity[j] && (theta2[k] == -theta[j] || theta[j] == -M_PI);
      assert_true(found >= 1);
    }
  }
  kz_dynamics_free(a);
  kz_dynamics_free(b);
}

/* A period of ICM converges to a period of integration with the order of its interpolation. */
TEST(test_interpolation) {
  kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  enum { N = 500 };
  for (int points = 2; points <= 6; points += 4) {
    double error[2] = {0, 0};
    for (int fine = 0; fine < 2; fine++) {
      kz_dynamics *d = kz_dynamics_create(&pendulum, fine_numerics(), 4);
      double x[2 * N], y[2 * N];
      int32_t label[N];
      int64_t periods[N];
      kz_dynamics_starts(&WINDOW, 3, N, x);
      memcpy(y, x, sizeof y);
      kz_dynamics_regions(d, 0, 3);
      with_table(d, (fine ? 400 : 200) + 1, 3);
      kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 1, x, label, periods, NULL);
      kz_dynamics_follow(d, points == 2 ? KZ_FOLLOW_LINEAR : KZ_FOLLOW_QUINTIC, N, 1, y, label, periods, NULL);
      for (int i = 0; i < N; i++) {
        double du = x[2 * i] - y[2 * i];
        error[fine] += fabs(du - 2 * rint(du / 2)) + fabs(x[2 * i + 1] - y[2 * i + 1]);
      }
      kz_dynamics_free(d);
    }
    double order = log2(error[0] / error[1]);
    print_message("%d nodes: order %.2f\n", points, order);
    assert_true(fabs(order - points) < 0.5);
  }
}

/* Regions that grew with every attractor found are those that grow around all of them at once. */
TEST(test_regions_know_no_order) {
  enum { N = 20000 / PART, CELLS = PART > 1 ? 150 : 300 };
  kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_dynamics *a = explored_with(fine_numerics(), 0.3, 1, CELLS, 3),
              *b = kz_dynamics_create(&pendulum, fine_numerics(), 12);
  const int64_t size = kz_dynamics_pack(a, 0, NULL);
  double *packed = malloc((size_t)size * sizeof *packed), *x = malloc(2 * N * sizeof *x);
  int32_t *label_a = malloc(N * sizeof *label_a), *label_b = malloc(N * sizeof *label_b), trapped = 0;
  int64_t *periods = malloc(N * sizeof *periods);
  kz_dynamics_update(a);
  kz_dynamics_pack(a, size, packed);
  kz_dynamics_unpack(b, size, packed);
  kz_dynamics_regions(b, CELLS, 3);
  assert_true(kz_dynamics_trapped_share(a) == kz_dynamics_trapped_share(b));
  kz_dynamics_starts(&WINDOW, 3, N, x);
  kz_dynamics_follow(a, KZ_FOLLOW_DIRECT, N, 1, x, label_a, periods, NULL);
  kz_dynamics_starts(&WINDOW, 3, N, x);
  kz_dynamics_follow(b, KZ_FOLLOW_DIRECT, N, 1, x, label_b, periods, NULL);
  for (int i = 0; i < N; i++) {
    assert_int_equal(label_a[i], label_b[i]);
    trapped += label_a[i] > 0;
  }
  print_message("%d of %d starts trapped at once\n", trapped, N);
  assert_true(trapped > N / 4 && trapped < N);
  free(packed);
  free(x);
  free(label_a);
  free(label_b);
  free(periods);
  kz_dynamics_free(a);
  kz_dynamics_free(b);
}

/* k = 0.25, beta = 0.05, m = 0.5: one chaotic attractor owns the plane. */
TEST(test_chaos) {
  enum { N = 256 / PART };
  static const double TOP = 4.0 * 199 / 195; /* a cover's cells belong to a grid of this height */
  kz_pendulum pendulum = {0.25, 0.05, 0.5};
  kz_dynamics *d = kz_dynamics_create(&pendulum, fine_numerics(), 48);
  double x[2 * N];
  int32_t label[N];
  int64_t periods[N];
  kz_attractor row;
  kz_dynamics_starts(&WINDOW, 1, N, x);
  kz_dynamics_regions(d, 0, TOP);
  double *found = calloc((size_t)kz_dynamics_find_size(d, KZ_FIND_CHAOS), sizeof *found);
  kz_dynamics_find(d, KZ_FIND_CHAOS, 1, x, 0, found);
  assert_int_equal(kz_dynamics_count(d), 0);
  kz_dynamics_adopt(d, found);
  free(found);
  assert_int_equal(kz_dynamics_count(d), 1);
  kz_dynamics_update(d);
  kz_dynamics_attractor(d, 1, &row);
  assert_int_equal(row.period, 0);
  assert_int_equal(row.symmetric, 1);
  assert_true(row.lyapunov > 0.8 && row.lyapunov < 0.9 && row.lyapunov_error < 0.02);
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 2000, x, label, periods, NULL);
  for (int i = 0; i < N; i++) assert_int_equal(label[i], 1);
  kz_dynamics_starts(&WINDOW, 1, N, x); /* errors grow on it, but who comes to it stays */
  for (int i = 0; i < N; i++) x[2 * i] *= M_PI;
  label_starts(d, next_cheaper(KZ_LEVEL_DOUBLE), N, x, label);
  int doubtful = 0; /* 2 of 2048 pass a gap of its cover, and none of these; another rounding may let one through */
  for (int i = 0; i < N; i++) doubtful += label[i] == KZ_DOUBTFUL;
  for (int i = 0; i < N; i++) assert_true(label[i] == 1 || label[i] == KZ_DOUBTFUL);
  assert_in_range(doubtful, 0, 1);
  with_table(d, 200, TOP);
  kz_dynamics_starts(&WINDOW, 1, N, x);
  kz_dynamics_follow(d, KZ_FOLLOW_QUINTIC, N, 2000, x, label, periods, NULL);
  for (int i = 0; i < N; i++) assert_int_equal(label[i], 1);
  kz_dynamics_free(d);
}

/* Starts of a weakly damped pendulum end alike if regions are looked at in some periods only, later by less than these
 * times the periods of a cycle: one that motions spiral into slowly has a region at its first strobe point alone. */
TEST(test_sparse_looks) {
  enum { N = PART > 1 ? 64 : 512, MOST = 3000, LATER = 7 * 12 };
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 550, 0.3};
  kz_dynamics *d = kz_dynamics_create(&pendulum, fine_numerics(), 12);
  double x[2][2 * N];
  int32_t label[2][N];
  int64_t periods[2][N], later = 0, settled = 0;
  kz_dynamics_regions(d, 0, 3);
  kz_dynamics_starts(&WINDOW, 1, N, x[0]);
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, N, 1000, x[0], label[0], periods[0], NULL);
  for (int first = 0; first < N; first += 64) find_cycles(d, 64, x[0] + 2 * first, 0.02);
  assert_true(kz_dynamics_count(d) >= (PART > 1 ? 4 : 6));
  kz_dynamics_update(d);
  for (int way = 0; way < 2; way++) {
    kz_dynamics_starts(&WINDOW, 2, N, x[way]);
    kz_dynamics_follow(d, way == 0 ? KZ_FOLLOW_DIRECT : KZ_FOLLOW_SPARSE, N, MOST, x[way], label[way], periods[way],
                       NULL);
  }
  for (int i = 0; i < N; i++) {
    if (label[0][i] == 0 || periods[0][i] > MOST - LATER) continue;
    assert_int_equal(label[1][i], label[0][i]);
    assert_true(periods[1][i] >= periods[0][i] && periods[1][i] < periods[0][i] + LATER);
    later += periods[1][i] - periods[0][i];
    settled++;
  }
  assert_true(settled > N * 9 / 10 && later > 2 * settled);
  kz_dynamics_free(d);
}

/* Single precision agrees with doubles to 5e-6 rad, with and without symmetry; with it images mirror to the bit. */
TEST(test_single_precision) {
  enum { N = 96 };
  const kz_pendulum pendulums[] = {{1.0 / 121, 1.0 / 2200, 0.3},
                                   {.k = 1.0 / 121, .beta = 1.0 / 2200, .m = 0.3, .torque = 0.001, .unmirrored = 1}};
  const kz_numerics processed = {.scheme = kz_scheme_find("processed"), .steps_per_period = 12};
  for (int p = 0; p < 2; p++) {
    kz_dynamics *d = kz_dynamics_create(pendulums + p, &processed, 12);
    double x[3][2 * N], farthest = 0;
    int32_t label[N];
    int64_t periods[N];
    kz_dynamics_regions(d, 0, 3);
    for (int way = 0; way < 3; way++) {
      kz_dynamics_starts(&WINDOW, 5, N, x[way]);
      for (int i = 0; way == 2 && i < 2 * N; i++) x[2][i] = -x[2][i];
      kz_dynamics_follow(d, way == 0 ? KZ_FOLLOW_DIRECT : KZ_FOLLOW_SINGLE, N, 1, x[way], label, periods, NULL);
    }
    for (int i = 0; i < 2 * N; i += 2) {
      farthest = fmax(farthest, hypot(M_PI * remainder(x[1][i] - x[0][i], 2), x[1][i + 1] - x[0][i + 1]));
      if (p == 0) assert_true(x[2][i] == -x[1][i] && x[2][i + 1] == -x[1][i + 1]);
    }
    assert_true(farthest > 1e-9 && farthest < 5e-6);
    kz_dynamics_free(d);
  }
}

/* A torque turns this pendulum faster and faster, until it runs in step with nothing. Its neighbours part by a factor
 * of 90, and no further: it is no chaos, within the regions or beyond. (It was, and beyond the regions the program
 * crashed.) */
TEST(test_quasi_periodic_motions_are_no_chaos) {
  const kz_pendulum pendulum = {.k = 1.0 / 121, .beta = 0.0025, .m = 1.855, .torque = 0.01, .unmirrored = 1};
  const double tops[] = {1.5, 5};
  if (PART > 1) return; /* test_chaos shows the sanitizers the same code */
  for (int i = 0; i < 2; i++) {
    kz_dynamics *d = kz_dynamics_create(&pendulum, fine_numerics(), 48);
    double x[2] = {0.5, 4}, *found = calloc((size_t)kz_dynamics_find_size(d, KZ_FIND_CHAOS), sizeof *found);
    kz_dynamics_regions(d, 0, tops[i]);
    kz_dynamics_find(d, KZ_FIND_CHAOS, 1, x, 0, found);
    kz_dynamics_adopt(d, found);
    kz_dynamics_update(d);
    assert_int_equal(kz_dynamics_count(d), 0);
    free(found);
    kz_dynamics_free(d);
  }
}
