/* The derivatives of a period: against the neighbourhoods of orbits in many digits, differences, and the published
 * map. */
#include "../../tools/test.h"

#include <math.h>

#include "kapitza/kernel.h"
#include "kapitza/kernel_digits.h"

enum { TERMS = 15, STEPS = 96 };
/* tests/unit/jets.f90: pendulum [3] = itself, what grows with p and with q; derivative [TERMS][2]. */
void kz_test_jets(const kz_pendulum *pendulum, int32_t steps, int32_t order, int32_t halves, double state[2],
                  double derivative[][2]);

static const double PI = 3.14159265358979323846;
static const double STARTS[][2] = {{0.3, 0.1}, {-2, 0.7}, {3, -1.2}};

/* All numbers of the drive in use: damping, torque, harmonics of both drives; and the directions of p and q. */
static void jets_pendulums(kz_pendulum pendulum[3]) {
  pendulum[0] = (kz_pendulum){
      .k = 0.1, .beta = 0.09, .m = 0.6, .torque = 0.02, .torque_amplitude = 0.3, .harmonics = 2, .unmirrored = 1};
  pendulum[1] = (kz_pendulum){.k = -0.3, .beta = 0.4, .m = 0.2, .torque = 0.5, .torque_amplitude = -0.4};
  pendulum[2] = (kz_pendulum){.k = 1, .beta = -0.2, .m = -0.7};
  pendulum[0].vertical[1][0] = 0.11;
  pendulum[0].horizontal[0][1] = 0.07;
  pendulum[1].vertical[1][1] = 0.3;
  pendulum[2].horizontal[0][0] = -0.6;
}

/* Degrees 1 to 3 in the start, without other drives and with, by the Taylor polynomials in many digits. */
TEST(test_arbitrary) {
  static const int place[] = {4, 5, 6, 11, 12, 13, 14}; /* Places of xx, xy, yy, xxx, xxy, xyy, yyy */
  static const double factorial[] = {2, 1, 2, 6, 2, 2, 6};
  kz_pendulum pendulum[3] = {{.k = 0.1, .beta = 0.09, .m = 0.6}};
  for (int all = 0; all < 6; all++) {
    const int i = all % 3;
    if (all == 3) jets_pendulums(pendulum);
    double x[2] = {STARTS[i][0], STARTS[i][1]}, got[TERMS][2];
    const kz_coordinate start[2] = {{.high = x[0]}, {.high = x[1]}};
    kz_jet jet = {.linear = {{1, 0}, {0, 1}}};
    kz_arbitrary *orbit = kz_arbitrary_create(pendulum, start, KZ_FEWEST_BITS);
    assert_int_equal(kz_arbitrary_advance(orbit, KZ_FEWEST_BITS, 3, &jet), KZ_OK);
    kz_arbitrary_free(orbit);
    kz_test_jets(pendulum, STEPS, 3, 0, x, got);
    for (int r = 0; r < 2; r++) {
      for (int c = 0; c < 2; c++) assert_true(fabs(got[c][r] - (double)jet.linear[r][c]) < 1e-10);
      for (int c = 0; c < KZ_HIGHER_TERMS; c++) {
        const double known = factorial[c] * (double)jet.higher_terms[r][c];
        assert_true(fabs(got[place[c]][r] - known) < 1e-10 * (1 + fabs(known)));
      }
    }
  }
}

/* The pendulum itself and its tangent, d times along direction `along` (0: none). */
static void jets_shifted(const kz_pendulum *pendulum, int along, double d, const double start[2], double image[2],
                         double got[][2]) {
  kz_pendulum moved[3] = {pendulum[0], pendulum[1], pendulum[2]};
  if (along) {
    const kz_pendulum *by = pendulum + along;
    moved->k += d * by->k, moved->beta += d * by->beta, moved->m += d * by->m, moved->torque += d * by->torque;
    moved->torque_amplitude += d * by->torque_amplitude;
    for (int j = 0; j < KZ_HARMONICS; j++)
      for (int i = 0; i < 2; i++)
        moved->vertical[j][i] += d * by->vertical[j][i], moved->horizontal[j][i] += d * by->horizontal[j][i];
  }
  image[0] = start[0], image[1] = start[1];
  kz_test_jets(moved, STEPS, 2, 0, image, got);
}

/* Derivatives by the parameters, and of the tangent by them, against central differences. */
TEST(test_differences) {
  kz_pendulum pendulum[3];
  const double d = 1e-4;
  jets_pendulums(pendulum);
  for (int i = 0; i < 3; i++)
    for (int along = 1; along <= 2; along++) {
      double here[2], up[2], down[2], at[TERMS][2], above[TERMS][2], below[TERMS][2];
      jets_shifted(pendulum, 0, 0, STARTS[i], here, at);
      jets_shifted(pendulum, along, d, STARTS[i], up, above);
      jets_shifted(pendulum, along, -d, STARTS[i], down, below);
      for (int r = 0; r < 2; r++) {
        const int mixed = along == 1 ? 7 : 9; /* xp, yp or xq, yq */
        const double by = (up[r] - down[r]) / (2 * d);
        assert_true(fabs(at[1 + along][r] - by) < 1e-5 * (1 + fabs(by)));
        for (int c = 0; c < 2; c++) {
          const double of_tangent = (above[c][r] - below[c][r]) / (2 * d);
          assert_true(fabs(at[mixed + c][r] - of_tangent) < 2e-5 * (1 + fabs(of_tangent)));
        }
      }
    }
}

/* State and tangent are those of the published map, with every drive and without; half a period twice is a period. */
TEST(test_published) {
  for (int drive = 0; drive < 2; drive++) {
    kz_pendulum pendulum[3] = {{.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.5}, {.k = 1}, {.m = 1}};
    if (drive) jets_pendulums(pendulum);
    const kz_numerics numerics = {.scheme = kz_scheme_find("split6"), .steps_per_period = STEPS};
    kz_flow *flow = kz_flow_create(pendulum, &numerics);
    for (int i = 0; i < 3; i++) {
      double theta = STARTS[i][0], velocity = STARTS[i][1], matrix[4];
      int64_t turns = 0;
      kz_advance_tangent(flow, 1, 1, &theta, &velocity, &turns, matrix);
      for (int halves = 0; halves <= 2; halves += 2) {
        double x[2] = {STARTS[i][0], STARTS[i][1]}, got[TERMS][2];
        kz_test_jets(pendulum, STEPS, 1 + halves, halves, x, got);
        assert_true(fabs(x[0] - theta - 2 * PI * (double)turns) < 1e-13 && fabs(x[1] - velocity) < 1e-13);
        for (int r = 0; r < 2; r++)
          for (int c = 0; c < 2; c++) assert_true(fabs(got[c][r] - matrix[2 * r + c]) < 1e-12);
      }
    }
    kz_flow_free(flow);
  }
}
