/* The symmetries of a drive against the equation of motion, evaluated here. */
#include "../../tools/test.h"

#include <math.h>

#include "kapitza/model.h"

static const double PI = 3.14159265358979323846;

/* Angular acceleration without damping, which keeps every symmetry. */
static double symmetries_acceleration(const kz_pendulum *p, double theta, double t) {
  double a = p->k - p->m * cos(t), b = 0;
  for (int j = 1; j <= p->harmonics; j++) {
    a -= p->vertical[j - 1][0] * cos(j * t) + p->vertical[j - 1][1] * sin(j * t);
    b += p->horizontal[j - 1][0] * cos(j * t) + p->horizontal[j - 1][1] * sin(j * t);
  }
  return p->torque + p->torque_amplitude * cos(t) - a * sin(theta) + b * cos(theta);
}

/* Symmetries that hold at places all over a period. */
static int32_t symmetries_of_equation(const kz_pendulum *p) {
  int32_t kept = KZ_SYMMETRY_MIRROR | KZ_SYMMETRY_HALF_PERIOD | KZ_SYMMETRY_HALF_TURN;
  for (int i = 0; i < 200; i++) {
    const double theta = 0.7 * i, t = 1.3 * i * i, here = symmetries_acceleration(p, theta, t);
    if (fabs(symmetries_acceleration(p, -theta, t) + here) > 1e-9) kept &= ~KZ_SYMMETRY_MIRROR;
    if (fabs(symmetries_acceleration(p, -theta, t + PI) + here) > 1e-9) kept &= ~KZ_SYMMETRY_HALF_PERIOD;
    if (fabs(symmetries_acceleration(p, theta + PI, t + PI) - here) > 1e-9) kept &= ~KZ_SYMMETRY_HALF_TURN;
  }
  return kept;
}

enum { MIRROR = KZ_SYMMETRY_MIRROR, HALF_PERIOD = KZ_SYMMETRY_HALF_PERIOD, HALF_TURN = KZ_SYMMETRY_HALF_TURN };
static const struct {
  kz_pendulum pendulum;
  int32_t symmetries, pairing;
} rows[] = {
    {{.k = 0.1, .m = 0.3}, MIRROR, MIRROR},
    {{.m = 0.3}, MIRROR | HALF_TURN, MIRROR},
    {{.k = 0.1}, MIRROR | HALF_PERIOD, MIRROR},
    {{.k = 0.1, .vertical = {{0}, {0.2, 0.1}}, .harmonics = 2}, MIRROR | HALF_PERIOD, MIRROR},
    {{.m = 0.3, .vertical = {{0}, {0.2, 0.1}}, .harmonics = 2}, MIRROR, MIRROR},
    {{.k = 0.1, .torque_amplitude = 1, .unmirrored = 1}, HALF_PERIOD, HALF_PERIOD},
    {{.k = 0.1, .torque = 0.1, .torque_amplitude = 1, .unmirrored = 1}, 0, 0},
    {{.m = 0.3, .torque = 0.1, .unmirrored = 1}, HALF_TURN, 0},
    {{.k = 0.1, .m = 0.3, .torque_amplitude = 1, .unmirrored = 1}, 0, 0},
    {{.k = 0.1, .horizontal = {{0.2, 0.1}}, .harmonics = 1, .unmirrored = 1}, HALF_PERIOD, HALF_PERIOD},
    {{.k = 0.1, .horizontal = {{0}, {0.2, 0.1}}, .harmonics = 2, .unmirrored = 1}, 0, 0},
    {{.horizontal = {{0.2}, {0}, {0, 0.1}}, .harmonics = 3, .unmirrored = 1}, HALF_PERIOD | HALF_TURN, HALF_PERIOD},
    {{.k = 0.1, .m = 0.3, .vertical = {{-0.3}}, .horizontal = {{0.3}}, .harmonics = 1, .unmirrored = 1},
     HALF_PERIOD,
     HALF_PERIOD},
};

TEST(symmetries_are_those_of_the_equation) {
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    assert_int_equal(symmetries_of_equation(&rows[i].pendulum), rows[i].symmetries);
    assert_int_equal(kz_symmetries(&rows[i].pendulum), rows[i].symmetries);
    assert_int_equal(kz_pairing_symmetry(&rows[i].pendulum), rows[i].pairing);
  }
}
