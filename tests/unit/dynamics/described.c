/* Everything of a cycle from one of its strobe points, against physics known to many digits (Q = 5, Omega = 11); maps
 * of neighbouring pendulums. */
#include "../../tools/test.h"

#include <math.h>

#include "../../tools/part.h"
#include "kapitza/dynamics_live.h"
#include "kapitza/dynamics_curves.h"
#include "kapitza/dynamics_labels.h"
#include "kapitza/dynamics_cycles.h"
#include "kapitza/dynamics_steps.h"

static const double PI = 3.14159265358979323846;

static kz_pendulum described_pendulum(double m) {
  return (kz_pendulum){1.0 / 121, 1.0 / 55, m};
}

/* By one of its strobe points. */
static void described_describe(kz_fine_maps *maps, const kz_pendulum *p, kz_attractor *point) {
  const double state[] = {point->theta, point->velocity};
  kz_branch_describe(maps, p, 1, state, point);
}

/* The published amplitude of flutter; the product of its multipliers. */
TEST(test_flutter) {
  const kz_pendulum p = described_pendulum(0.47);
  kz_attractor point = {
      .theta = PI + 0.161076997267223124, .velocity = -0.002241504186408954, .period = 2, .symmetric = 1};
  described_describe(NULL, &p, &point);
  assert_true(point.centre == 1 && point.winding == 0 && point.theta < 0);
  assert_true(fabs(point.amplitude - 0.16111093243808042) < 1e-9);
  assert_true(fabs(hypot(point.multiplier_re[0], point.multiplier_im[0]) - exp(-2 * PI / 55)) < 1e-9);
}

/* Rotations have their winding, mirror images are other cycles, any point gives the same whole orbit. */
TEST(test_rotation) {
  const kz_pendulum p = described_pendulum(0.3);
  kz_attractor point = {.theta = 3.0164225972238, .velocity = 1.06881051489920, .period = 1}, image;
  described_describe(NULL, &p, &point);
  assert_true(point.winding == 1 && point.centre == 2);
  assert_true(fabs(point.multiplier_re[0] + 0.7133) < 1e-4 && fabs(point.multiplier_im[0] - 0.6191) < 1e-4);
  image = (kz_attractor){.theta = -point.theta, .velocity = -point.velocity, .period = 1};
  described_describe(NULL, &p, &image);
  assert_int_equal(image.winding, -1);
  assert_int_equal(kz_branch_same(NULL, &p, &point, &image), 0);
  assert_int_equal(kz_branch_same(NULL, &p, &point, &point), 1);
}

/* All strobe points of a cycle give the same description: the flutter, and a rotation followed three times. */
TEST(test_points) {
  const kz_pendulum p[] = {described_pendulum(0.47), described_pendulum(0.3)};
  const double start[][2] = {{PI + 0.161076997267223124, -0.002241504186408954}, {3.0164225972238, 1.06881051489920}};
  for (int i = 0; i < 2; i++) {
    const int n = i == 0 ? 2 : 3;
    kz_attractor one = {.theta = start[i][0], .velocity = start[i][1], .period = n}, all = {.period = n};
    double state[6];
    for (int j = 0; j < n; j++) {
      const double sign = i == 0 && j == 1 ? -1 : 1;
      state[2 * j] = sign * start[i][0];
      state[2 * j + 1] = sign * start[i][1];
    }
    described_describe(NULL, p + i, &one);
    kz_branch_describe(NULL, p + i, n, state, &all);
    assert_int_equal(all.winding, i == 0 ? 0 : 3);
    assert_true(all.winding == one.winding && all.centre == one.centre && all.period == n);
    assert_true(all.theta == one.theta && all.velocity == one.velocity && fabs(all.amplitude - one.amplitude) < 1e-10);
    for (int j = 0; j < 2; j++)
      assert_true(hypot(all.multiplier_re[j] - one.multiplier_re[j], all.multiplier_im[j] - one.multiplier_im[j]) <
                  1e-9);
  }
}

static bool same_pendulum(const void *context, const double place[2], kz_pendulum *p) {
  (void)place;
  *p = *(const kz_pendulum *)context;
  return true;
}

/* The multiplier of a cycle that repels by 3e8 is that of the map's derivative at its points, which Newton's method
 * has; an orbit that is followed once round leaves the cycle, and its multiplier is off by 1e-6. */
TEST(test_repelling) {
  enum { N = 9 };
  const kz_pendulum p = described_pendulum(0.5682051282051281);
  const kz_plane plane = {same_pendulum, &p, {0, -1}, {1, 1}, .steps = 192, .mirrored = 1};
  kz_cycle cycle = {.kind = {1, N, 0, 3}, .point = {{1.457070978577512, 0.16176735831871347}}};
  kz_attractor point = {.period = N};
  assert_true(kz_curve_orbit(&plane, cycle.place, 2, N - 1, cycle.point[0]));
  assert_true(kz_cycle_solve(&plane, &cycle));
  kz_branch_describe(NULL, &p, N, cycle.point[0], &point);
  assert_true(point.winding == 3 && fabs(cycle.number[0]) > 2e8);
  assert_true(fabs(point.multiplier_re[0] / cycle.number[0] - 1) < 1e-7);
}

/* More pendulums than maps are kept, in turns: what is said of a cycle does not depend on which maps are kept. */
TEST(test_kept_maps) {
  kz_fine_maps *maps = kz_fine_maps_create(2);
  const double m[] = {0.3, 0.3, 0.31, 0.32, 0.3, 0.32};
  for (size_t i = 0; i < sizeof m / sizeof m[0]; i++) {
    const kz_pendulum p = described_pendulum(m[i]);
    kz_attractor point = {.theta = 3.0164225972238, .velocity = 1.06881051489920, .period = 3}, again = point;
    described_describe(NULL, &p, &point);
    described_describe(maps, &p, &again);
    assert_memory_equal(&point, &again, sizeof point);
    again.velocity += 1e-3;
    assert_int_equal(kz_branch_same(maps, &p, &point, &again), kz_branch_same(NULL, &p, &point, &again));
  }
  kz_fine_maps_free(maps);
}

/* Where three periods take a start, in the coordinates of the map. */
static void described_carry(kz_dynamics *dynamics, double end[2]) {
  int32_t label;
  int64_t periods;
  end[0] = 0.3;
  end[1] = 0.4;
  kz_dynamics_follow(dynamics, KZ_FOLLOW_DIRECT, 1, 3, end, &label, &periods, NULL);
}

/* How far the map of a pendulum that was moved is from that of one made anew. */
static double described_strayed(kz_dynamics *moved, const kz_pendulum *p, const kz_numerics *numerics) {
  kz_dynamics *anew = kz_dynamics_create(p, numerics, 4);
  double end[2], known[2];
  kz_dynamics_regions(moved, 0, 3);
  kz_dynamics_regions(anew, 0, 3);
  described_carry(moved, end);
  described_carry(anew, known);
  kz_dynamics_free(anew);
  return fmax(fabs(end[0] - known[0]), fabs(end[1] - known[1]));
}

/* Moves a pendulum along a curve, with maps of the accepted error. Returns the largest difference of the maps;
 * *interpolated = how many maps are not those of pendulums made anew to the bit. */
static double described_drag(int steps, kz_pendulum (*curve)(double share), double accepted, int *interpolated) {
  kz_numerics numerics = {.scheme = kz_scheme_find("processed"), .steps_per_period = 40}, kept = numerics;
  kz_pendulum p = curve(0);
  double most = 0;
  kept.series = kz_kept_series_create();
  kz_dynamics *moved = kz_dynamics_create(&p, &kept, 4);
  kz_dynamics_regions(moved, 0, 3);
  *interpolated = 0;
  for (int i = 1; i <= steps; i++) {
    int64_t lost;
    p = curve((double)i / steps);
    kz_dynamics *next = kz_dynamics_continue(moved, &p, &kept, accepted, &lost);
    kz_dynamics_free(moved);
    moved = next;
    const double error = described_strayed(moved, &p, &numerics);
    most = fmax(most, error);
    *interpolated += error > 0;
  }
  kz_dynamics_free(moved);
  kz_kept_series_free(kept.series);
  return most;
}

/* Forwards, a leap, back. */
static double there_and_back(double share) {
  return share < 0.5 ? 0.012 * share : 0.05 + 0.012 * (1 - share);
}

static kz_pendulum along_k(double share) {
  kz_pendulum p = described_pendulum(0.3);
  p.k += there_and_back(share);
  return p;
}

static kz_pendulum along_m(double share) {
  return described_pendulum(0.3 + there_and_back(share));
}

/* A circle over the plane of drive frequency and amplitude. */
static kz_pendulum described_around(double share) {
  const double frequency = 11.5 - 0.5 * cos(2 * PI * share), amplitude = 0.31 - 0.01 * sin(2 * PI * share);
  return (kz_pendulum){1 / (frequency * frequency), 1 / (10 * frequency), amplitude};
}

/* Wherever a hand moves a pendulum, along one key or over a plane, its coefficients are interpolated: most maps are not
 * made anew, and they are those of pendulums made anew but for the error that is accepted. The more of it, the fewer
 * are made. */
TEST(test_moved_pendulums) {
  enum { STEPS = PART > 1 ? 12 : 48 };
  kz_pendulum (*const curve[])(double) = {along_k, along_m, described_around};
  for (int i = PART > 1 ? 2 : 0; i < 3; i++) {
    int coarse, fine;
    assert_true(described_drag(STEPS, curve[i], 1e-10, &fine) < 1e-10);
    assert_true(PART > 1 || fine > STEPS / 2);
    assert_true(described_drag(STEPS, curve[i], 1e-6, &coarse) < 1e-6);
    assert_true(PART > 1 || coarse > fine);
  }
}

/* Kept errors of a period belong to this pendulum, steps and speeds, even after enough others to forget all. */
TEST(errors_of_a_period_are_kept) {
  kz_kept_series *series = kz_kept_series_create();
  const double speed[] = {0, 1, 2}, faster[] = {0, 1, 3};
  for (int round = 0; round < 2; round++)
    for (int i = 0; i < 60; i++) {
      const kz_pendulum p = described_pendulum(0.3 + 0.01 * (i % 30));
      kz_numerics numerics = {.scheme = kz_scheme_find("split6"), .steps_per_period = 8 + i / 30};
      double anew[2], kept[2], again[2];
      kz_step_errors(&p, &numerics, 2, round ? faster : speed, anew);
      numerics.series = series;
      kz_step_errors(&p, &numerics, 2, round ? faster : speed, kept);
      kz_step_errors(&p, &numerics, 2, round ? faster : speed, again);
      assert_memory_equal(kept, anew, sizeof anew);
      assert_memory_equal(again, anew, sizeof anew);
    }
  kz_kept_series_free(series);
}
