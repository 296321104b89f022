/* The kernel: sine, mirror symmetry, lanes, tangent map, sampling; every scheme. */
#include "../../tools/reference.h"
#include "../../tools/test.h"

#include "../../tools/part.h"
#include "kapitza/kernel.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static const kz_pendulum PENDULUM = {1.0 / 121, 1.0 / 55, 0.3};
static const double EPSILON = 0x1p-53;

enum { N = 200 };

static void kernel_starts(double *theta, double *velocity, int64_t *turns) {
  for (int i = 0; i < N; i++) {
    theta[i] = fmod(0.7548776662 * (i + 1), 1.0) * 6.2 - 3.1;
    velocity[i] = fmod(0.5698402910 * (i + 1), 1.0) * 4 - 2;
    turns[i] = 0;
  }
}

/* One period by the reference in quad precision. */
static void true_period(const kz_pendulum *pendulum, int64_t n, double *theta, double *velocity, int64_t *turns) {
  kz_reference_state states[N];
  kz_reference_start(n, theta, velocity, NULL, states);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, n, 1, states);
  kz_reference_read(n, states, theta, velocity, turns);
}

static kz_flow *flow_under(const kz_pendulum *pendulum, int scheme, int steps) {
  kz_numerics numerics = {.scheme = scheme, .steps_per_period = steps};
  kz_flow *flow = kz_flow_create(pendulum, &numerics);
  assert_non_null(flow);
  return flow;
}

static kz_flow *flow_of(int scheme, int steps) {
  return flow_under(&PENDULUM, scheme, steps);
}

/* Drives beyond k - m cos t, which rk4 does not know; number DRIVES is the sine. */
enum { DRIVES = 4 };
static kz_pendulum kernel_drive(int which) {
  if (which == DRIVES) return PENDULUM;
  kz_pendulum p = {.k = 0.05, .beta = 0.1, .m = 0.4};
  if (which == 0) p.harmonics = 2, p.vertical[1][0] = 0.2, p.vertical[1][1] = -0.1;
  if (which == 1)
    p.harmonics = 1, p.unmirrored = 1, p.vertical[0][0] = -0.05, p.horizontal[0][0] = 0.1, p.horizontal[0][1] = 0.07;
  if (which == 2) p.unmirrored = 1, p.torque = 0.1, p.torque_amplitude = 0.3;
  if (which == 3) p.harmonics = 7, p.vertical[2][0] = -0.15, p.vertical[4][0] = 0.1, p.vertical[6][1] = 0.05;
  return p;
}

/* tests/unit/neighbours.f90 */
double kz_test_sine(double u);

/* sin(pi u) within 2 units in the last place over the wrapped range and beyond. */
TEST(test_sine) {
  for (int i = -30000; i <= 30000; i++) {
    const double u = i / 10000.0, s = kz_test_sine(u);
    double nearest = rint(u);
    long double exact = sinl(3.14159265358979323846264338327950288L * ((long double)u - nearest));
    if (fmod(fabs(nearest), 2) == 1) exact = -exact;
    if (exact == 0)
      assert_true(s == 0);
    else
      assert_true(fabsl(s / exact - 1) <= 4 * EPSILON);
  }
}

/* (-theta, -v) has the mirror image of (theta, v)'s image, to the bit, unless there is a torque or a drive across. */
TEST(test_mirror) {
  for (int way = 0; way < (DRIVES + 1) * kz_scheme_count(); way++) {
    const int scheme = way / (DRIVES + 1), which = way % (DRIVES + 1);
    if (scheme == 0 && which < DRIVES) continue;
    const kz_pendulum pendulum = kernel_drive(which);
    double a[N], va[N], b[N], vb[N];
    int64_t ta[N], tb[N];
    int mirrored = 0;
    kz_flow *flow = flow_under(&pendulum, scheme, 16);
    kernel_starts(a, va, ta);
    memcpy(tb, ta, sizeof tb);
    for (int i = 0; i < N; i++) b[i] = -a[i], vb[i] = -va[i];
    kz_advance(flow, N, 5, a, va, ta);
    kz_advance(flow, N, 5, b, vb, tb);
    for (int i = 0; i < N; i++) mirrored += a[i] == -b[i] && va[i] == -vb[i] && ta[i] == -tb[i] && fabs(a[i]) <= M_PI;
    assert_int_equal(mirrored, kz_is_mirrored(&pendulum) ? N : 0);
    kz_flow_free(flow);
  }
}

/* A start gives the same bits alone and in any lane of a tile. */
TEST(test_lanes) {
  for (int scheme = 0; scheme < kz_scheme_count(); scheme++) {
    double a[N], va[N];
    int64_t ta[N];
    kz_flow *flow = flow_of(scheme, 24);
    kernel_starts(a, va, ta);
    kz_advance(flow, N, 7, a, va, ta);
    for (int i = 0; i < N; i += 9) {
      double b[N], vb[N];
      int64_t tb[N];
      kernel_starts(b, vb, tb);
      kz_advance(flow, 1, 7, b + i, vb + i, tb + i);
      assert_true(a[i] == b[i] && va[i] == vb[i] && ta[i] == tb[i]);
    }
    kz_flow_free(flow);
  }
}

/* With the tangent map states move as without, and the matrix of a start is the same alone and in any lane. */
TEST(test_tangent_lanes) {
  for (int scheme = 0; scheme < kz_scheme_count(); scheme++) {
    double a[N], va[N], matrix[N][4], b[N], vb[N], alone[4];
    int64_t ta[N], tb[N];
    kz_flow *flow = flow_of(scheme, 24);
    kernel_starts(a, va, ta);
    kernel_starts(b, vb, tb);
    kz_advance_tangent(flow, N, 7, a, va, ta, matrix[0]);
    kz_advance(flow, N, 7, b, vb, tb);
    for (int i = 0; i < N; i++) assert_true(a[i] == b[i] && va[i] == vb[i] && ta[i] == tb[i]);
    kernel_starts(b, vb, tb);
    for (int i = 0; i < N; i += 9) {
      kz_advance_tangent(flow, 1, 7, b + i, vb + i, tb + i, alone);
      assert_memory_equal(alone, matrix[i], sizeof alone);
    }
    kz_flow_free(flow);
  }
}

/* The split schemes contract areas by exactly exp(-2 pi beta) a period; rk4 nearly; the processed one in its own
 * coordinates, in the physical ones but for the truncation of the change of coordinates. A period has up to 2100
 * stages, each with its rounding. */
TEST(test_determinant) {
  for (int way = 0; way < (DRIVES + 1) * kz_scheme_count(); way++) {
    const int scheme = way / (DRIVES + 1), which = way % (DRIVES + 1);
    if (scheme == 0 && which < DRIVES) continue;
    const kz_pendulum pendulum = kernel_drive(which);
    double theta[N], velocity[N], matrix[N][4];
    int64_t turns[N];
    kz_flow *flow = flow_under(&pendulum, scheme, scheme == 0 ? 400 : which < DRIVES ? 150 : 24);
    kernel_starts(theta, velocity, turns);
    kz_advance_tangent(flow, N, 1, theta, velocity, turns, matrix[0]);
    for (int i = 0; i < N; i++) {
      double determinant = matrix[i][0] * matrix[i][3] - matrix[i][1] * matrix[i][2];
      double scale = fabs(matrix[i][0] * matrix[i][3]) + fabs(matrix[i][1] * matrix[i][2]);
      double error = fabs(determinant - exp(-2 * M_PI * pendulum.beta));
      assert_true(error <= 2000 * EPSILON * scale + (scheme == 0                             ? 1e-9
                                                     : scheme == kz_scheme_find("processed") ? 1e-10
                                                                                             : 0));
    }
    kz_flow_free(flow);
  }
}

/* The inverted pendulum at rest stays there exactly, whatever the drive. */
TEST(test_rest) {
  const kz_pendulum pendulums[] = {
      {1.0 / 121, 1.0 / 55, 0.3}, {0, 0, 0.46}, {-1, 0.1, 0.6}, {5, 0.1, 0.5}, {0.01, 0.5, 3}};
  for (int i = 0; i < 5; i++) {
    const kz_numerics numerics = {.scheme = kz_scheme_find("processed"), .steps_per_period = 40};
    kz_flow *flow = kz_flow_create(&pendulums[i], &numerics);
    double theta[2] = {M_PI, -M_PI}, velocity[2] = {0, 0};
    int64_t turns[2] = {0};
    kz_advance(flow, 2, 1000, theta, velocity, turns);
    for (int j = 0; j < 2; j++) assert_true(fabs(theta[j]) == M_PI && velocity[j] == 0);
    kz_flow_free(flow);
  }
}

/* The chosen number of steps keeps its promise on states it was not measured on; fast states go by split6. */
TEST(test_choice) {
  const struct {
    kz_pendulum pendulum;
    double fastest, tolerance;
  } cases[] = {{{1.0 / 121, 1.0 / 55, 0.3}, 2, 1e-12},
               {{1.0 / 121, 1.0 / 55, 0.46}, 2, 3e-10},
               {{0.1, 0.1, 1.5}, 3, 1e-7},
               {{0, 0, 0.3}, 8, 1e-10},
               {{-1, 0.1, 0.6}, 2, 1e-9},
               {{0.1, 2.4, 0.5}, 2, 1e-11}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c += PART > 1 ? 2 : 1) {
    kz_numerics numerics = {0};
    double error, a[N], va[N], b[N], vb[N];
    int64_t ta[N], tb[N];
    assert_int_equal(kz_numerics_choose(&cases[c].pendulum, cases[c].tolerance, cases[c].fastest, &numerics, &error),
                     KZ_OK);
    assert_true(error <= cases[c].tolerance);
    kz_flow *flow = kz_flow_create(&cases[c].pendulum, &numerics);
    const int n = 40;
    for (int i = 0; i < n; i++) {
      a[i] = fmod(2.399963 * i, 2 * M_PI) - M_PI;
      va[i] = cases[c].fastest * (fmod(0.7548776662 * (i + 1), 2) - 1) * (i % 10 == 0 ? 1.5 : 1); /* also fast */
      b[i] = a[i], vb[i] = va[i], ta[i] = tb[i] = 0;
    }
    kz_advance(flow, n, 1, a, va, ta);
    true_period(&cases[c].pendulum, n, b, vb, tb);
    for (int i = 0; i < n; i++)
      assert_true(hypot(remainder(a[i] - b[i], 2 * M_PI), va[i] - vb[i]) <= fmax(error, i % 10 == 0 ? 1e-8 : 0));
    kz_flow_free(flow);
  }
  const kz_pendulum strong = {100, 0.1, 1}, overdamped = {0.1, 5, 0.5};
  kz_numerics numerics = {0};
  double error;
  assert_int_equal(kz_numerics_choose(&strong, 1e-10, 2, &numerics, &error), KZ_REFUSED);
  assert_int_equal(kz_numerics_choose(&overdamped, 1e-10, 2, &numerics, &error), KZ_REFUSED);
}

/* Both splittings, of other drives; released.c holds the reference against orbits of many digits. */
TEST(test_drives) {
  static const char *const schemes[] = {"split6", "processed"};
  static const int32_t steps[] = {192, 150};
  for (int which = 0; which < DRIVES; which += PART > 1 ? 2 : 1) {
    const kz_pendulum p = kernel_drive(which);
    double theta[N], velocity[N], x[N], v[N];
    int64_t turns[N];
    kernel_starts(theta, velocity, turns);
    true_period(&p, 40, theta, velocity, turns);
    for (int scheme = 0; scheme < 2; scheme++) {
      kz_flow *flow = flow_under(&p, kz_scheme_find(schemes[scheme]), steps[scheme]);
      kernel_starts(x, v, turns);
      kz_advance(flow, 40, 1, x, v, turns);
      kz_flow_free(flow);
      for (int i = 0; i < 40; i++)
        assert_true(fabs(remainder(x[i] - theta[i], 2 * M_PI)) < 1e-11 && fabs(v[i] - velocity[i]) < 1e-11);
    }
  }
}

/* An integrator of the sixth order whose rounding is known. */
typedef struct {
  double scale, rounding;
  int tries;
} sixth_order;

static double error_of_sixth_order(int32_t steps, void *context) {
  sixth_order *s = context;
  s->tries++;
  return s->scale * pow(steps, -6) + s->rounding;
}

/* Enough steps and hardly more, in few tries; none where rounding or the largest number of steps forbids it. */
TEST(test_search) {
  int32_t steps;
  for (double scale = 1; scale < 1e12; scale *= 7) {
    sixth_order s = {scale, 1e-15, 0};
    const double enough = kz_expected_steps(1, scale, 1e-10, 6);
    assert_true(kz_steps_search(error_of_sixth_order, &s, 6, 1e-10, 12, 100000, &steps) <= 1e-10);
    assert_true(steps >= floor(enough) && steps <= fmax(12, 1.3 * enough + 2));
    assert_true(s.tries < 16);
    s = (sixth_order){scale, 1e-9, 0};
    assert_true(kz_steps_search(error_of_sixth_order, &s, 6, 1e-10, 12, 100000, &steps) > 1e-10);
    assert_true(s.tries < 24 && steps <= 100000);
    s = (sixth_order){scale, 0, 0};
    assert_true(kz_steps_search(error_of_sixth_order, &s, 6, 1e-10, 12, (int32_t)(enough / 2), &steps) > 1e-10);
    assert_true(steps <= enough / 2);
  }
}

/* The tangent map is the derivative of the map. */
TEST(test_tangent) {
  const double h = 1e-5;
  for (int way = 0; way < (DRIVES + 1) * kz_scheme_count(); way++) {
    const int scheme = way / (DRIVES + 1), which = way % (DRIVES + 1);
    if (scheme == 0 && which < DRIVES) continue;
    const kz_pendulum pendulum = kernel_drive(which);
    kz_flow *flow = flow_under(&pendulum, scheme, 24);
    double theta = 0.7, velocity = -0.3, matrix[4], x[4] = {0.7 + h, 0.7 - h, 0.7, 0.7},
           v[4] = {-0.3, -0.3, -0.3 + h, -0.3 - h};
    int64_t turn = 0, turns[4] = {0};
    kz_advance_tangent(flow, 1, 2, &theta, &velocity, &turn, matrix);
    kz_advance(flow, 4, 2, x, v, turns);
    for (int c = 0; c < 2; c++) {
      assert_true(fabs(remainder(x[2 * c] - x[2 * c + 1], 2 * M_PI) / (2 * h) - matrix[c]) < 1e-6);
      assert_true(fabs((v[2 * c] - v[2 * c + 1]) / (2 * h) - matrix[2 + c]) < 1e-6);
    }
    kz_flow_free(flow);
  }
}

/* Samples at whole periods are the strobe points, and theta is unwrapped. */
TEST(test_sample) {
  for (int scheme = 0; scheme < kz_scheme_count(); scheme++) {
    kz_flow *flow = flow_of(scheme, 48);
    double theta = 3.0, velocity = 1.1, series[10 * 24 + 1], speeds[10 * 24 + 1];
    int64_t turns = 0;
    kz_sample(flow, 10, 24, theta, velocity, series, speeds);
    kz_advance(flow, 1, 10, &theta, &velocity, &turns);
    assert_true(fabs(series[240] - (theta + 2 * M_PI * (double)turns)) < 1e-11);
    assert_true(fabs(speeds[240] - velocity) < 1e-12);
    assert_true(turns > 0);
    for (int i = 0; i < 240; i++) assert_true(fabs(series[i + 1] - series[i]) < 0.8);
    kz_flow_free(flow);
  }
}

/* Whether this processor, here and now, knows numbers below DBL_MIN. */
static bool has_subnormals(void) {
  volatile double smallest = DBL_MIN;
  return smallest / 2 > 0;
}

/* A decay onto the exact inverted point has no subnormal numbers, which take 15 times as long; the caller's may. */
TEST(test_subnormals) {
  for (int scheme = 0; scheme < kz_scheme_count(); scheme++) {
    double theta[] = {M_PI, M_PI}, velocity[] = {4 * DBL_MIN, -4 * DBL_MIN}, matrix[8], series[3], speeds[3];
    int64_t turns[2] = {0};
    kz_flow *flow = flow_of(scheme, 24);
    kz_sample(flow, 2, 1, theta[0], velocity[0] / 8, series, speeds);
    assert_true(speeds[1] == 0 && speeds[2] == 0);
    for (int period = 0; period < 40; period++) {
      if (period % 2)
        kz_advance(flow, 2, 1, theta, velocity, turns);
      else
        kz_advance_tangent(flow, 2, 1, theta, velocity, turns, matrix);
      assert_true(theta[0] == M_PI && velocity[0] == -velocity[1]);
      assert_true(velocity[0] == 0 || velocity[0] >= DBL_MIN);
      assert_true(has_subnormals());
    }
    kz_flow_free(flow);
  }
}

/* tests/unit/neighbours.f90 */
double kz_test_neighbour_error(const kz_pendulum *pendulum, int32_t scheme, int32_t steps, double fastest,
                               double distance);

/* Neighbours that are moved beside their orbits go where they go by themselves: with mirror symmetry, without it, in
 * lanes too fast for the tables, and by a scheme that has no tables. */
TEST(test_neighbours) {
  kz_pendulum turned = {.k = 0.1, .beta = 0.1, .m = 0.4, .unmirrored = 1, .harmonics = 1, .horizontal = {{0.1, 0.07}}};
  turned.torque = 0.1, turned.torque_amplitude = 0.2;
  const struct {
    const kz_pendulum *pendulum;
    const char *scheme;
    int32_t steps;
    double fastest;
  } kinds[] = {{&PENDULUM, "processed", 40, 2},
               {&turned, "processed", 40, 2},
               {&PENDULUM, "processed", 40, 6},
               {&PENDULUM, "split6", 24, 2}};
  for (int i = 0; i < 4; i += PART > 1 ? 3 : 1)
    for (double distance = 3e-4; distance < 0.1; distance *= 10)
      assert_true(kz_test_neighbour_error(kinds[i].pendulum, kz_scheme_find(kinds[i].scheme), kinds[i].steps,
                                          kinds[i].fastest, distance) < 1e-3);
}
