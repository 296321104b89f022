/* Releases at a phase of the drive and on a ramp: orbits in many digits (kernel/digits) against those in quad precision
 * (kernel/taylor), whose drive comes from src/model, and their neighbourhoods against neighbours. */
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>

#include "kapitza/dynamics_labels.h"
#include "kapitza/dynamics_release.h"
#include "kapitza/kernel_digits.h"

enum { BITS = 200, STARTS = 3 };

static const kz_pendulum pendulum = {.k = 0.1,
                                     .beta = 0.1,
                                     .m = 0.4,
                                     .torque = 0.05,
                                     .torque_amplitude = 0.2,
                                     .vertical = {{-0.05, 0.02}, {0.1, -0.03}},
                                     .horizontal = {{0.1, 0.07}, {0, 0}, {-0.04, 0.03}},
                                     .harmonics = 3,
                                     .unmirrored = 1};
/* A phase alone; ramps that end at a strobe, within a period, within the first one; of the drive, of the damping. */
static const kz_release releases[] = {{.phase = 1, .damping = 0.1, .drive = 1},
                                      {.phase = -7.5, .periods = 2.5, .damping = 0.1, .drive = 0.3, .smooth = 1},
                                      {.periods = 3, .damping = 0.7, .drive = 1},
                                      {.phase = 2, .periods = 0.6, .damping = 0.1, .drive = 1.7},
                                      {.phase = 6, .periods = 1, .damping = 0, .drive = 1, .smooth = 1}};
enum { RELEASES = sizeof releases / sizeof *releases };

static kz_arbitrary *released_released(const kz_release *release, double theta, double velocity) {
  const kz_coordinate start[2] = {{.high = theta}, {.high = velocity}};
  kz_arbitrary *orbit = kz_arbitrary_create(&pendulum, start, BITS);
  kz_arbitrary_release(orbit, release);
  return orbit;
}

static void released_advance(kz_arbitrary *orbit, int64_t periods, kz_jet *jet) {
  for (int64_t i = 0; i < periods; i++) assert_int_equal(kz_arbitrary_advance(orbit, BITS, jet ? 3 : 0, jet), KZ_OK);
}

TEST(many_digits_agree_with_quads) {
  const kz_numerics numerics = {.scheme = kz_scheme_find("split6"), .steps_per_period = 48};
  kz_dynamics *d = kz_dynamics_create(&pendulum, &numerics, 12);
  kz_dynamics_regions(d, 0, 3);
  for (int i = 0; i < RELEASES; i++) {
    kz_start start[STARTS] = {
        {.theta = {0.7}, .velocity = {1.42}}, {.theta = {-2.5}, .velocity = {-1}}, {.theta = {3.1}}};
    kz_arbitrary *orbit[STARTS];
    for (int j = 0; j < STARTS; j++)
      orbit[j] = released_released(releases + i, start[j].theta[0], start[j].velocity[0]);
    kz_dynamics_set_release(d, releases + i);
    kz_dynamics_begin(d, KZ_LEVEL_QUAD, STARTS, start);
    for (int j = 0; j < STARTS; j++) {
      double theta[2], velocity[2];
      assert_int_equal(start[j].periods, kz_release_strobes(releases + i));
      released_advance(orbit[j], start[j].periods, NULL);
      kz_arbitrary_read(orbit[j], theta, velocity);
      assert_true(fabs(remainder(start[j].theta[0] - theta[0], 2 * M_PI) + (start[j].theta[1] - theta[1])) < 1e-28);
      assert_true(fabs((start[j].velocity[0] - velocity[0]) + (start[j].velocity[1] - velocity[1])) < 1e-28);
      kz_arbitrary_free(orbit[j]);
    }
    kz_dynamics_begin(d, KZ_LEVEL_QUAD, STARTS, start); /* they are released only once */
    assert_int_equal(start[0].periods, kz_release_strobes(releases + i));
  }
  kz_dynamics_free(d);
}

/* The second order by the difference of two neighbours on opposite sides, the first by their sum. */
TEST(neighbours_follow_the_jet) {
  const double h = 1e-6;
  for (int i = 0; i < RELEASES; i++) {
    const int64_t n = kz_release_strobes(releases + i) + 1;
    kz_jet jet = {.linear = {{1, 0}, {0, 1}}}, alone = jet;
    double x[3][2][2];
    for (int j = 0; j < 3; j++) {
      kz_arbitrary *orbit = released_released(releases + i, 0.75 + (j < 2 ? h * (1 - 2 * j) : 0), 1.5);
      released_advance(orbit, n, j == 2 ? &jet : NULL);
      kz_arbitrary_read(orbit, x[j][0], x[j][1]);
      kz_arbitrary_free(orbit);
    }
    kz_arbitrary *orbit = released_released(releases + i, 0.75, 1.5);
    for (int64_t period = 0; period < n; period++)
      assert_int_equal(kz_arbitrary_advance(orbit, BITS, 1, &alone), KZ_OK);
    kz_arbitrary_free(orbit);
    for (int axis = 0; axis < 2; axis++) {
      const double up = (x[0][axis][0] - x[2][axis][0]) + (x[0][axis][1] - x[2][axis][1]),
                   down = (x[1][axis][0] - x[2][axis][0]) + (x[1][axis][1] - x[2][axis][1]);
      const double width = ((0.75 + h) - (0.75 - h)) / 2, first = (double)jet.linear[axis][0],
                   second = (double)jet.higher_terms[axis][0];
      assert_true(fabs((up - down) / (2 * width) - first) < 1e-9 * (1 + fabs(first)));
      assert_true(fabs((up + down) / (2 * width * width) - second) < 1e-6 * (1 + fabs(second)));
      assert_true(fabs((double)(alone.linear[axis][0] - jet.linear[axis][0])) < 1e-14 * (1 + fabs(first)));
    }
  }
}

/* A checkpoint in the middle of a ramp. */
TEST(a_kept_orbit_goes_on) {
  kz_arbitrary *orbit = released_released(releases + 1, 0.7, 1.4), *again = released_released(releases + 1, 0, 0);
  char *text[2] = {malloc(kz_arbitrary_size(orbit)), malloc(kz_arbitrary_size(orbit))};
  released_advance(orbit, 2, NULL);
  kz_arbitrary_write(orbit, text[0]);
  assert_int_equal(kz_arbitrary_restore(again, text[0]), KZ_OK);
  released_advance(orbit, 2, NULL);
  released_advance(again, 2, NULL);
  kz_arbitrary_write(orbit, text[0]);
  kz_arbitrary_write(again, text[1]);
  assert_memory_equal(text[0], text[1], kz_arbitrary_size(orbit));
  for (int i = 0; i < 2; i++) free(text[i]);
  kz_arbitrary_free(orbit);
  kz_arbitrary_free(again);
}
