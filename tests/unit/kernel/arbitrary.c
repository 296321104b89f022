/* Orbits of any precision against the quad reference, against themselves in more digits, and their neighbourhoods
 * against neighbours. */
#define OWN_MAIN
#include "../../tools/reference.h"
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "digits/number.h"
#include "kapitza/kernel.h"
#include "kapitza/kernel_digits.h"

/* A sine, and everything that a drive can have. */
static const kz_pendulum pendulums[] = {{.k = 0.1, .beta = 0.1, .m = 0.4},
                                        {.k = 0.1,
                                         .beta = 0.1,
                                         .m = 0.4,
                                         .torque = 0.05,
                                         .torque_amplitude = 0.2,
                                         .vertical = {{-0.05, 0.02}, {0.1, -0.03}, {0, 0}, {0.02, 0.05}},
                                         .horizontal = {{0.1, 0.07}, {0, 0}, {-0.04, 0.03}},
                                         .harmonics = 4,
                                         .unmirrored = 1}};
static kz_pendulum strong; /* Pendulum of the present group of tests */

static kz_coordinate arbitrary_at(double value) {
  return (kz_coordinate){.high = value};
}

static kz_arbitrary *orbit_at(double theta, double velocity, int64_t bits) {
  const kz_coordinate start[2] = {arbitrary_at(theta), arbitrary_at(velocity)};
  kz_arbitrary *orbit = kz_arbitrary_create(&strong, start, bits);
  assert_non_null(orbit);
  return orbit;
}

static void arbitrary_advance(kz_arbitrary *orbit, int periods, int64_t bits, kz_jet *jet) {
  for (int i = 0; i < periods; i++) assert_int_equal(kz_arbitrary_advance(orbit, bits, jet ? 3 : 0, jet), KZ_OK);
}

/* The distance of two states as their pairs tell it. */
static double arbitrary_distance(const kz_arbitrary *a, const kz_arbitrary *b) {
  double theta[2][2], velocity[2][2];
  kz_arbitrary_read(a, theta[0], velocity[0]);
  kz_arbitrary_read(b, theta[1], velocity[1]);
  return hypot(theta[0][0] - theta[1][0] + (theta[0][1] - theta[1][1]),
               velocity[0][0] - velocity[1][0] + (velocity[0][1] - velocity[1][1]));
}

/* rad: how far a period in quad precision is from the motion. */
static double arbitrary_missed(const kz_pendulum *pendulum, double theta, double velocity) {
  const kz_coordinate start[2] = {arbitrary_at(theta), arbitrary_at(velocity)};
  kz_arbitrary *orbit = kz_arbitrary_create(pendulum, start, 200);
  kz_reference_state quad;
  __float128 end[2], state[2];
  kz_reference_start(1, &theta, &velocity, NULL, &quad);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, 1, 1, &quad);
  memcpy(end, quad.quads, sizeof end);
  assert_int_equal(kz_arbitrary_advance(orbit, 200, 0, NULL), KZ_OK);
  char *text = malloc(kz_arbitrary_size(orbit));
  KZ_NUMBER(x);
  kz_arbitrary_write(orbit, text);
  for (int i = 0; i < 2; i++) {
    assert_true(kz_number_read(text + i * kz_arbitrary_size(orbit) / 2, &x));
    state[i] = kz_number_quad(&x);
  }
  free(text);
  kz_arbitrary_free(orbit);
  assert_true(fabs((double)(end[0] - state[0])) < 1); /* not on either side of the seam */
  return hypot((double)(end[0] - state[0]), (double)(end[1] - state[1]));
}

/* The error told of the quad reference holds. It was assumed to be 1e-31 of the motion, which it is not where the drive
 * is strong. */
TEST(errors_of_quads_are_not_understated) {
  if (strong.unmirrored) skip();
  static const kz_pendulum strong_drives[] = {{.k = 1, .beta = 0.5, .m = 7.7},
                                              {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.46}};
  static const double starts[][2] = {{-0.57601889359626179, 0.92164362479996953},
                                     {1.7401103791778954, -12.380928537600042},
                                     {-0.092368924726252022, 6.6726473615999424}};
  for (int p = 0; p < 2; p++) {
    const double told = kz_reference_error(strong_drives + p, 13);
    double largest = 0;
    for (int i = 0; i < 3; i++)
      largest =
          fmax(largest, arbitrary_missed(strong_drives + p, starts[i][0], starts[i][1]) / hypot(M_PI, starts[i][1]));
    print_message("m %g: %.1e, told %.1e\n", strong_drives[p].m, largest, told);
    assert_true(largest <= told);
    assert_true(told < (p == 0 ? 1e-30 : 1e-32)); /* the second at 1e-31 left half as many more undecided */
  }
}

/* Fewer bits leave out some units of the last bit. */
TEST(more_digits_agree) {
  kz_arbitrary *orbit = orbit_at(-2.3, 17, 400), *coarse = orbit_at(-2.3, 17, 400);
  arbitrary_advance(orbit, 4, 400, NULL);
  arbitrary_advance(coarse, 4, 200, NULL);
  /* Their difference is below what pairs show; their texts begin alike */
  assert_true(arbitrary_distance(orbit, coarse) < 1e-31);
  char *text = malloc(kz_arbitrary_size(orbit));
  kz_arbitrary_write(orbit, text);
  kz_arbitrary *again = orbit_at(0, 0, 400);
  assert_int_equal(kz_arbitrary_restore(again, text), KZ_OK);
  arbitrary_advance(orbit, 1, 400, NULL);
  arbitrary_advance(again, 1, 400, NULL);
  char *other = malloc(kz_arbitrary_size(orbit));
  kz_arbitrary_write(orbit, text);
  kz_arbitrary_write(again, other);
  assert_memory_equal(text, other, kz_arbitrary_size(orbit));
  assert_int_equal(kz_arbitrary_restore(again, "no number"), KZ_FAILED);
  kz_message_clear();
  free(text);
  free(other);
  kz_arbitrary_free(orbit);
  kz_arbitrary_free(coarse);
  kz_arbitrary_free(again);
}

static long double value_of(const __float128 *linear, const long double *b, long double x, long double y) {
  return (long double)linear[0] * x + (long double)linear[1] * y + b[0] * x * x + b[1] * x * y + b[2] * y * y +
         b[3] * x * x * x + b[4] * x * x * y + b[5] * x * y * y + b[6] * y * y * y;
}

/* The first degree alone is that of a whole neighbourhood, to long doubles: in motion, fast, and at rest. */
TEST(a_tangent_alone_is_the_same) {
  static const double start[][2] = {{0.7, 1.42}, {-2.3, 17}, {0, 0}};
  for (int i = 0; i < 3; i++) {
    kz_arbitrary *orbit[2];
    kz_jet jet[2];
    for (int j = 0; j < 2; j++) {
      orbit[j] = orbit_at(start[i][0], start[i][1], 160);
      jet[j] = (kz_jet){.linear = {{1, 0}, {0, 1}}};
      for (int period = 0; period < 3; period++)
        assert_int_equal(kz_arbitrary_advance(orbit[j], 160, j == 0 ? 3 : 1, &jet[j]), KZ_OK);
      kz_arbitrary_free(orbit[j]);
    }
    for (int axis = 0; axis < 4; axis++) {
      const double exact = (double)jet[0].linear[axis / 2][axis % 2],
                   off = (double)(jet[1].linear[axis / 2][axis % 2] - exact);
      assert_true(exact != 0 && fabs(off) < 1e-14 * fabs(exact));
    }
  }
}

/* A neighbour at 1e-4 is where the cubic says, to the fourth power of the distance; and at 1e-9 to the rounding of long
 * doubles. */
TEST(neighbours_follow_the_jet) {
  for (int i = 0; i < 2; i++) {
    const double scale = i == 0 ? 1e-4 : 1e-9, bound = i == 0 ? 3e-11 : 1e-28;
    kz_arbitrary *centre = orbit_at(0.7, 1.42, 160), *beside = orbit_at(0.7 + scale, 1.42 - scale, 160);
    kz_jet jet = {.linear = {{1, 0}, {0, 1}}};
    arbitrary_advance(centre, 3, 160, &jet);
    arbitrary_advance(beside, 3, 160, NULL);
    double a[2][2], b[2][2];
    kz_arbitrary_read(centre, a[0], a[1]);
    kz_arbitrary_read(beside, b[0], b[1]);
    for (int axis = 0; axis < 2; axis++) {
      const long double dx = (0.7 + scale) - 0.7, dy = (1.42 - scale) - 1.42;
      const long double moved = (long double)b[axis][0] - a[axis][0] + ((long double)b[axis][1] - a[axis][1]);
      assert_true(fabsl(moved - value_of(jet.linear[axis], jet.higher_terms[axis], dx, dy)) < bound);
    }
    kz_arbitrary_free(centre);
    kz_arbitrary_free(beside);
  }
}

/* The widest and the narrowest window: exponents of cubes stay, areas shrink by exp(-2 pi beta). */
TEST(areas_shrink_at_any_scale) {
  const long double scale[] = {1, 1e-300L};
  for (int i = 0; i < 2; i++) {
    kz_arbitrary *orbit = orbit_at(2.1, -0.4, 200);
    kz_jet jet = {.linear = {{scale[i], 0}, {0, scale[i]}}};
    arbitrary_advance(orbit, 5, 200, &jet);
    const __float128 det = jet.linear[0][0] * jet.linear[1][1] - jet.linear[0][1] * jet.linear[1][0];
    assert_true(fabs((double)(det / scale[i] / scale[i]) / exp(-10 * M_PI * strong.beta) - 1) <= 1e-13);
    for (int part = 3; part < KZ_HIGHER_TERMS; part++) assert_true(jet.higher_terms[0][part] != 0);
    kz_arbitrary_free(orbit);
  }
}

/* At rest an orbit has no series, but its neighbours move: as near the equilibrium as beside it. */
TEST(neighbours_of_rest_move) {
  if (strong.unmirrored) skip();
  kz_arbitrary *rest = orbit_at(0, 0, 160), *beside = orbit_at(1e-12, 0, 160);
  kz_jet jet = {.linear = {{1, 0}, {0, 1}}};
  double theta[2], velocity[2];
  arbitrary_advance(rest, 2, 160, &jet);
  arbitrary_advance(beside, 2, 160, NULL);
  kz_arbitrary_read(beside, theta, velocity);
  assert_true(fabs(theta[0] - 1e-12 * (double)jet.linear[0][0]) < 1e-27);
  assert_true(fabs(velocity[0] - 1e-12 * (double)jet.linear[1][0]) < 1e-27);
  kz_arbitrary_free(rest);
  kz_arbitrary_free(beside);
}

/* Centres in decimal text, in degrees, and a share of a width. */
TEST(starts_are_read) {
  const kz_coordinate text[2] = {{.centre = "-90 deg"}, {.centre = "1.5", .width = "1e-10", .share = -0.25}};
  kz_arbitrary *orbit = kz_arbitrary_create(&strong, text, 200);
  double theta[2], velocity[2];
  kz_arbitrary_read(orbit, theta, velocity);
  assert_true(theta[0] == -M_PI / 2 && fabs(theta[1] + 6.123233995736766e-17) < 1e-31);
  assert_true(fabs((velocity[0] - 1.5) + velocity[1] + 2.5e-11) <= 1e-26);
  kz_arbitrary_free(orbit);
}

/* Mirrored starts stay mirrored, to the last bit. */
TEST(mirror_images_stay_mirrored) {
  if (strong.unmirrored) skip();
  kz_arbitrary *orbit = orbit_at(2.5, 3.2, 180), *mirror = orbit_at(-2.5, -3.2, 180);
  double a[2][2], b[2][2];
  arbitrary_advance(orbit, 3, 180, NULL);
  arbitrary_advance(mirror, 3, 180, NULL);
  kz_arbitrary_read(orbit, a[0], a[1]);
  kz_arbitrary_read(mirror, b[0], b[1]);
  for (int i = 0; i < 4; i++) assert_true(a[i / 2][i % 2] == -b[i / 2][i % 2]);
  kz_arbitrary_free(orbit);
  kz_arbitrary_free(mirror);
}

int main(void) {
  int failed = 0;
  for (int i = 1; i >= 0; i--) {
    strong = pendulums[i];
    failed += run_all_tests(NULL, NULL);
  }
  return failed;
}
