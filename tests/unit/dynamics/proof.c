/* Proofs against orbits: no start ends elsewhere than where it is proved to end, and what cannot be proved is not. */
#include "../../tools/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "../../tools/part.h"
#include "kapitza/dynamics.h"
#include "kapitza/dynamics_proof.h"

/* Fig. 12's pendulum and its rotation of one turn a period (tests/literature). */
static const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
static const double THETA = 3.0164225972238, VELOCITY = 1.0688105148992;
enum { ROTATION = 1, OPPOSITE = 2, COLUMNS = 120, ROWS = 120, PERIODS = 250 };
static const double TOP = 2;

TEST(ellipses_that_hold_and_that_do_not) {
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  kz_proof_ellipse ellipse = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  assert_true(ellipse.radius > 0.3 && ellipse.radius < 1);
  ellipse.radius = 2e-3;
  assert_true(kz_proof_traps(proof, 1, THETA, VELOCITY, &ellipse));
  assert_false(kz_proof_traps(proof, 1, THETA, VELOCITY + 0.01, &ellipse)); /* the cycle lies outside */
  assert_false(
      kz_proof_traps(proof, 2, THETA, VELOCITY + 0.002, &(kz_proof_ellipse){2e-3, {{1, 0}, {0, 1}}})); /* other norm */
  ellipse.radius = 0.3;
  assert_false(kz_proof_traps(proof, 1, THETA, VELOCITY, &ellipse));
  assert_true(kz_proof_find_ellipse(proof, 1, 1.0, 0.5).radius <= 0); /* no cycle */
  kz_proof_free(proof);
  const kz_pendulum slow = {1.0 / 121, 1.0 / 55, 0.1}; /* inverted: a saddle */
  assert_int_equal(kz_proof_create(&slow, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  assert_true(kz_proof_find_ellipse(proof, 1, -M_PI, 0).radius <= 0);
  assert_true(kz_proof_find_ellipse(proof, 1, 0, 0).radius > 0.1);
  kz_proof_free(proof);
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, 1e9, &proof), KZ_REFUSED);
  kz_proof_free(proof);
}

/* Only the true mirror image of a cycle is proved to be one. */
TEST(mirror_images_are_proved) {
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  const double rotation[2] = {THETA, VELOCITY}, opposite[2] = {-THETA, -VELOCITY}, down[2] = {0, 0};
  const kz_proof_ellipse ellipse = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  const kz_proof_ellipse hanging = kz_proof_find_ellipse(proof, 1, 0, 0);
  assert_true(kz_proof_is_mirror(proof, 1, opposite, rotation, &ellipse));
  assert_false(kz_proof_is_mirror(proof, 1, rotation, rotation, &ellipse));
  assert_false(kz_proof_is_mirror(proof, 1, down, rotation, &ellipse));
  assert_true(kz_proof_is_mirror(proof, 1, down, down, &hanging));
  assert_false(kz_proof_is_mirror(proof, 1, rotation, down, &hanging));
  kz_proof_free(proof);
}

/* The grid and ellipses of Fig. 12's rotations. */
static kz_proof *region_of_rotations(void) {
  const uint8_t mirror[KZ_PROOF_MOST + 1] = {0, OPPOSITE, ROTATION};
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  const kz_proof_ellipse ellipse = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  kz_proof_add(proof, ROTATION, OPPOSITE, THETA, VELOCITY, &ellipse);
  const int64_t own = kz_proof_own(proof);
  uint8_t *label = malloc((size_t)own);
  int64_t added = 0;
  for (int round = 0; round < 2; round++) {
    kz_proof_cells(proof, 0, own / 2, label);
    kz_proof_cells(proof, own / 2, own - own / 2, label + own / 2);
    const int64_t more = kz_proof_adopt(proof, label, mirror);
    assert_true(more > 0);
    added += more;
  }
  assert_true(added > own / 20);
  free(label);
  return proof;
}

static int end_of(const kz_flow *flow, double theta, double velocity) {
  int64_t turns = 0;
  kz_advance(flow, 1, PERIODS, &theta, &velocity, &turns);
  return fabs(velocity - VELOCITY) < 1e-3 ? ROTATION : fabs(velocity + VELOCITY) < 1e-3 ? OPPOSITE : 0;
}

/* Starts of the window: those that end elsewhere are not proved, nearly all others and their images are. */
TEST(starts_end_where_they_are_said_to) {
  enum { N = PART > 1 ? 60 : 1000 };
  kz_proof *proof = region_of_rotations();
  static kz_proof_start start[N], image[N];
  static uint8_t number[N], image_number[N];
  srand(1);
  for (int i = 0; i < N; i++) {
    start[i] = (kz_proof_start){.theta = {M_PI * (2.0 * rand() / RAND_MAX - 1)},
                                .velocity = {TOP * (2.0 * rand() / RAND_MAX - 1)}};
    image[N - 1 - i] = (kz_proof_start){.theta = {-start[i].theta[0]}, .velocity = {-start[i].velocity[0]}};
  }
  kz_proof_follow(proof, KZ_ENCLOSE_DOUBLES, N, start, PERIODS, number);
  kz_proof_follow(proof, KZ_ENCLOSE_DOUBLES, N, image, PERIODS, image_number);
  kz_numerics numerics = {.scheme = kz_scheme_find("processed")};
  double error;
  assert_int_equal(kz_numerics_choose(&pendulum, 1e-9, 2.5, &numerics, &error), KZ_OK);
  kz_flow *flow = kz_flow_create(&pendulum, &numerics);
  int proved = 0, missed = 0;
  for (int i = 0; i < N; i++) {
    const bool is_proved = number[i] == ROTATION || number[i] == OPPOSITE;
    const int end = end_of(flow, start[i].theta[0], start[i].velocity[0]);
    assert_true(!is_proved || number[i] == end);
    assert_int_equal(image_number[N - 1 - i], is_proved ? 3 - number[i] : number[i]);
    proved += is_proved;
    missed += !is_proved && end > 0;
  }
  assert_true(proved > 0.3 * N && missed < 0.01 * N);
  kz_flow_free(flow);
  kz_proof_free(proof);
}

/* A start's result is its own, whoever goes with it; pairs prove what doubles do, and triples what pairs do. */
TEST(results_do_not_depend_on_neighbours) {
  enum { N = PART > 1 ? 6 : 32 };
  kz_proof *proof = region_of_rotations();
  kz_proof_start start[N];
  uint8_t number[N], in_pairs[N], in_triples[N];
  for (int i = 0; i < N; i++) start[i] = (kz_proof_start){.theta = {-3 + 0.18 * i}, .velocity = {1.9 - 0.1 * i}};
  kz_proof_follow(proof, KZ_ENCLOSE_DOUBLES, N, start, PERIODS, number);
  kz_proof_follow(proof, KZ_ENCLOSE_PAIRS, N, start, PERIODS, in_pairs);
  kz_proof_follow(proof, KZ_ENCLOSE_TRIPLES, N, start, PERIODS, in_triples);
  for (int i = 0; i < N; i++) {
    uint8_t alone;
    kz_proof_follow(proof, KZ_ENCLOSE_DOUBLES, 1, &start[i], PERIODS, &alone);
    assert_int_equal(alone, number[i]);
    if (number[i] != 0 && number[i] != KZ_PROOF_LATE) assert_int_equal(in_pairs[i], number[i]);
    if (in_pairs[i] != 0 && in_pairs[i] != KZ_PROOF_LATE) assert_int_equal(in_triples[i], in_pairs[i]);
  }
  kz_proof_free(proof);
}

/* Another pendulum has its cycle elsewhere; what is published is confined to some last places. */
TEST(cycles_are_confined) {
  const double theta[] = {THETA}, velocity[] = {VELOCITY}, wrong[] = {VELOCITY + 1e-9};
  const double re[] = {-0.22, -0.22}, im[] = {0.9, -0.9};
  kz_proof_cycle cycle = {1, theta, velocity, re, im};
  double half_theta, half_velocity, half_multiplier[2];
  kz_proof *proof;
  assert_int_equal(kz_proof_create(&pendulum, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  assert_true(kz_proof_confine(proof, &cycle, &half_theta, &half_velocity, half_multiplier));
  assert_true(half_theta < 1e-11 && half_velocity < 1e-11);
  cycle.velocity = wrong;
  assert_true(kz_proof_confine(proof, &cycle, &half_theta, &half_velocity, half_multiplier));
  assert_true(half_velocity > 1e-9); /* the half-width must reach the cycle */
  kz_proof_free(proof);
  const kz_pendulum other = {pendulum.k, pendulum.beta, pendulum.m + 1e-3};
  assert_int_equal(kz_proof_create(&other, COLUMNS, ROWS, TOP, TOP, &proof), KZ_OK);
  cycle.velocity = velocity;
  kz_proof_ellipse small = kz_proof_find_ellipse(proof, 1, THETA, VELOCITY);
  small.radius = 1e-4;
  assert_false(kz_proof_traps(proof, 1, THETA, VELOCITY, &small));
  kz_proof_free(proof);
}
