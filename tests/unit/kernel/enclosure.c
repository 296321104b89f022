/* Enclosures of drive periods hold the motion in quad precision: random and adversarial starts, every kind of set; and
 * bounds that are made smaller do not. */
#include "../../tools/enclosed.h"
#include "../../tools/enclosed_orbit.h"
#include "../../tools/part.h"
#include "../../tools/reference.h"
#include "../../tools/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "enclosure/operations.h"

enum { SETS = 16, PERIODS = 3, DRAWS = PART > 1 ? 5 : 10 };

static double enclosure_uniform(double from, double to) {
  return from + (to - from) * rand() / RAND_MAX;
}

/* With a drive across, overtones and a torque; every second one is mirrored. */
static kz_pendulum some_drive(int draw) {
  kz_pendulum p = {.k = enclosure_uniform(-0.05, 0.3),
                   .beta = enclosure_uniform(0, 0.1),
                   .m = enclosure_uniform(-0.6, 0.6),
                   .harmonics = 7};
  for (int j = 0; j < p.harmonics; j++)
    for (int i = 0; i < 2; i++) p.vertical[j][i] = enclosure_uniform(-0.1, 0.1) / (j + 1);
  if (draw % 8 == 1) return p;
  for (int i = 0; i < 6; i++) p.horizontal[i / 2][i % 2] = enclosure_uniform(-0.1, 0.1);
  p.torque = enclosure_uniform(-0.1, 0.1);
  p.torque_amplitude = enclosure_uniform(-0.3, 0.3);
  p.unmirrored = 1;
  return p;
}

static kz_pendulum some_pendulum(int draw) {
  static const kz_pendulum chosen[] = {
      {1.0 / 121, 1.0 / 55, 0.3}, {-0.2, 0.01, 0.7}, {0, 0.3, 0.5}, {0.3, 0, -0.6}, {0.1, 1.2, 2}};
  if (draw % 2 == 0) return chosen[draw / 2 % 5];
  if (draw % 4 == 1) return some_drive(draw);
  return (kz_pendulum){enclosure_uniform(-0.05, 0.3), enclosure_uniform(0, 0.1), enclosure_uniform(-0.6, 0.6)};
}

/* Moves n states, at most 2 SETS, through some periods in quad precision: many at once, since each call makes tables
 * and fills lanes. */
static void move_truly(const kz_pendulum *pendulum, int n, int64_t periods, quad at[][2]) {
  kz_reference_state state[2 * SETS] = {{.turns = 0}};
  for (int i = 0; i < n; i++) memcpy(state[i].quads, at[i], sizeof state[i].quads);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, n, periods, state);
  for (int i = 0; i < n; i++) memcpy(at[i], state[i].quads, sizeof at[i]);
}

/* Sets at random starts, or where adversary: at turning points of the sine and of the torque's sign. */
static void place_sets(double fastest, double half, kz_enclosure begin[SETS]) {
  for (int i = 0; i < SETS; i++) {
    const double theta = i % 4 ? enclosure_uniform(-M_PI, M_PI) : (i % 8 ? M_PI / 2 : M_PI) * (i % 16 < 8 ? 1 : -1);
    begin[i] = set_at(theta, i % 5 ? enclosure_uniform(-fastest, fastest) : fastest * (i % 2 ? 1 : -1), half);
  }
}

/* The farthest of starts at the corners, on the edges and in the middle, over periods and sets. */
static double farthest_place(const kz_pendulum *pendulum, const kz_enclosure_tables *plan, double half, double fastest,
                             int *kept) {
  kz_enclosure begin[SETS], set[SETS];
  double farthest = 0;
  quad at[SETS][2];
  place_sets(fastest, half, begin);
  memcpy(set, begin, sizeof set);
  for (int i = 0; i < SETS; i++) {
    at[i][0] = (quad)begin[i].theta[0] + begin[i].theta[1] + (quad)(rand() % 3 - 1) * begin[i].reach[0];
    at[i][1] = (quad)begin[i].velocity[0] + begin[i].velocity[1] + (quad)(rand() % 3 - 1) * begin[i].reach[1];
  }
  for (int64_t period = 1; period <= PERIODS; period++) {
    kz_enclosures_advance(plan, KZ_NEW_FRAME, SETS, set);
    move_truly(pendulum, SETS, 1, at);
    for (int i = 0; i < SETS; i++) {
      double z[2];
      if (!isfinite(set[i].reach[0])) continue;
      place_of(at[i], &set[i], z);
      farthest = fmax(farthest, fmax(fabs(z[0]) / set[i].reach[0], fabs(z[1]) / set[i].reach[1]));
      *kept += set[i].reach[0] + set[i].reach[1] < 1e5 * half + 1e-6;
    }
  }
  return farthest;
}

static kz_enclosure_tables *plan_for(const kz_pendulum *pendulum, int32_t precision, double fastest) {
  kz_enclosure_tables *plan;
  const double most = fastest + 3 * kz_stiffness(pendulum);
  assert_int_equal(kz_enclosure_tables_create(pendulum, precision, most, &plan), KZ_OK);
  return plan;
}

TEST(points_hold_the_motion) {
  srand(1);
  double farthest[2] = {0};
  int kept = 0;
  for (int draw = 0; draw < DRAWS; draw++)
    for (int32_t precision = 0; precision < 2; precision++) {
      const kz_pendulum pendulum = some_pendulum(draw);
      const double fastest = draw == 3 ? 15 : 3;
      kz_enclosure_tables *plan = plan_for(&pendulum, precision, fastest);
      farthest[precision] = fmax(farthest[precision], farthest_place(&pendulum, plan, 0, fastest, &kept));
      kz_enclosure_tables_free(plan);
    }
  assert_true(farthest[0] < 1 && farthest[1] < 1 && kept > 0.9 * 2 * DRAWS * SETS * PERIODS);
}

/* Where steps are long, Taylor's rest is what a step of a centre misses: starts lie inside with it, and outside with
 * the rounding of short steps alone in its place. */
TEST(taylors_rest_is_needed) {
  const kz_pendulum pendulum = some_pendulum(0);
  for (int32_t precision = 0; precision < 2; precision++)
    for (int is_cut = 0; is_cut < 2; is_cut++) {
      kz_enclosure_tables *plan = plan_for(&pendulum, precision, 3);
      int kept = 0;
      for (int c = 0; c < plan->n_classes; c++) {
        kz_speed_class *fine = plan->classes[c],
                       *longer = kz_speed_class_create(&pendulum, precision, fine->fastest, fine->n_steps / 2);
        if (is_cut) longer->theta_error = fine->theta_error, longer->velocity_error = fine->velocity_error;
        assert_true(longer->velocity_error > (is_cut ? 0 : 1e3) * fine->velocity_error);
        plan->classes[c] = longer;
        free(fine);
      }
      srand(8);
      assert_true((farthest_place(&pendulum, plan, 0, 3, &kept) < 1) == !is_cut);
      assert_true(is_cut || kept > 0);
      kz_enclosure_tables_free(plan);
    }
}

/* The bounds of a lemma of docs/explanation/bounds.md, of all classes of speeds, times `left`. */
static void enclosure_cut(const kz_enclosure_tables *plan, int lemma, double left) {
  for (int c = 0; c < plan->n_classes; c++) {
    kz_speed_class *speed = plan->classes[c];
    double *const bound[] = {[3] = &speed->velocity_error,
                             [4] = &speed->tangent_error[0][0][0],
                             [5] = speed->neighbour_angle,
                             [6] = speed->nonlinear};
    const int count[] = {[3] = 1, [4] = 8, [5] = 2, [6] = 2};
    for (int i = 0; i < count[lemma]; i++) bound[lemma][i] *= left;
    if (lemma == 3) speed->theta_error *= left;
  }
}

/* The largest |z| / reach of sets of one point, against orbits in 200 bits; the errors of a step count `left` times. */
static double farthest_of_points(const kz_pendulum *pendulum, int32_t precision, double fastest, int periods,
                                 double left, kz_enclosure set[SETS]) {
  kz_enclosure_tables *plan = plan_for(pendulum, precision, fastest);
  kz_arbitrary *orbit[SETS];
  double farthest = 0, z[2];
  enclosure_cut(plan, 3, left);
  for (int i = 0; i < SETS; i++) {
    const kz_coordinate start[2] = {{.high = set[i].theta[0]}, {.high = set[i].velocity[0]}};
    orbit[i] = kz_arbitrary_create(pendulum, start, 200);
  }
  for (int period = 0; period < periods; period++) {
    kz_enclosures_advance(plan, KZ_NEW_FRAME, SETS, set);
    for (int i = 0; i < SETS; i++) {
      assert_int_equal(kz_arbitrary_advance(orbit[i], 200, 0, NULL), KZ_OK);
      place_of_orbit(orbit[i], &set[i], z);
      for (int j = 0; j < 2; j++) farthest = fmax(farthest, fabs(z[j]) / set[i].reach[j]);
    }
  }
  for (int i = 0; i < SETS; i++) kz_arbitrary_free(orbit[i]);
  kz_enclosure_tables_free(plan);
  return farthest;
}

TEST(points_in_triples_hold_the_motion) {
  srand(6);
  double farthest = 0, narrower = 0, outside = 0;
  static const int draws[] = {5, 0, 4, 1}; /* every kind of drive */
  for (int j = 0; j < (getenv("KAPITZA_EXTENSIVE") ? 4 : 1); j++) {
    const kz_pendulum pendulum = some_pendulum(draws[j]);
    const double fastest = draws[j] == 4 ? 15 : 3;
    kz_enclosure set[3][SETS];
    place_sets(fastest, 0, set[0]);
    memcpy(set[1], set[0], sizeof set[1]);
    memcpy(set[2], set[0], sizeof set[2]);
    farthest = fmax(farthest, farthest_of_points(&pendulum, KZ_ENCLOSE_TRIPLES, fastest, PERIODS, 1, set[0]));
    farthest = fmax(farthest, farthest_of_points(&pendulum, KZ_ENCLOSE_PAIRS, fastest, PERIODS, 1, set[1]));
    outside = fmax(outside, farthest_of_points(&pendulum, KZ_ENCLOSE_TRIPLES, fastest, 1, 1e-7, set[2]));
    for (int i = 0; i < SETS; i++)
      narrower = fmax(narrower, (set[0][i].reach[0] + set[0][i].reach[1]) / (set[1][i].reach[0] + set[1][i].reach[1]));
  }
  assert_true(farthest < 1 && farthest > 1e-4 && narrower < 1e-10 && outside > 1);
}

/* Single starts many turns away, where pairs know the angle to fewer digits than a step adds: |z| / reach after a
 * period. */
TEST(far_angles_hold_the_motion) {
  const kz_pendulum pendulum = some_pendulum(0);
  srand(7);
  for (int32_t precision = 0; precision < KZ_ENCLOSURES; precision++)
    for (double distance = 10; distance < 2e6; distance *= 1e4) {
      kz_enclosure set[SETS];
      for (int i = 0; i < SETS; i++)
        set[i] = set_at(enclosure_uniform(-distance, distance), enclosure_uniform(-3, 3), 0);
      assert_true(farthest_of_points(&pendulum, precision, 3, 1, 1, set) < 1);
    }
}

/* Damping makes the columns of a matrix alike. Once they are, a set is lost at once: it would shrink, and a new frame
 * would hide that. */
TEST(flat_frames_are_lost) {
  const kz_pendulum pendulum = {.k = 0.1, .beta = 3, .m = 0.3};
  kz_enclosure_tables *plan = plan_for(&pendulum, KZ_ENCLOSE_DOUBLES, 2);
  const kz_enclosure flat = {.matrix = {{1, 1}, {1, 1}}, .reach = {1e-3, 1e-3}};
  kz_sets sets[KZ_PARTS] = {{.lost = {0}}};
  kz_circle circle[KZ_PARTS];
  for (int lane = 0; lane < KZ_PARTS * LANES; lane++) put_set(&flat, lane % LANES, &sets[lane / LANES]);
  kz_centres_step_doubles(plan->classes[0], 0, sets, KZ_ORDER_TANGENT, circle);
  kz_neighbours_step(plan->classes[0], 0, &circle[0], false, &sets[0]);
  kz_sets_renew_frame(&sets[0]);
  assert_true(sets[0].lost[0]);
  kz_enclosure_tables_free(plan);
}

TEST(boxes_hold_the_motion) {
  srand(2);
  double farthest = 0;
  int kept = 0;
  for (int draw = 0; draw < DRAWS; draw++) {
    const kz_pendulum pendulum = some_pendulum(draw);
    kz_enclosure_tables *plan = plan_for(&pendulum, KZ_ENCLOSE_DOUBLES, 3);
    farthest = fmax(farthest, farthest_place(&pendulum, plan, draw % 3 ? 2e-3 : 3e-2, 3, &kept));
    kz_enclosure_tables_free(plan);
  }
  assert_true(farthest < 1 && farthest > 0.5 && kept > 0.3 * DRAWS * SETS * PERIODS);
}

/* The largest share of the growth of a set that a start at a corner takes, over a period; *bent: the same of the
 * difference of two corners. */
static double share_of_growth(const kz_pendulum *pendulum, const kz_enclosure_tables *plan, double half, double *bent) {
  static const double corner[2][2] = {{1, 1}, {-1, 1}};
  kz_enclosure begin[SETS], set[SETS];
  double largest = 0;
  *bent = 0;
  place_sets(2, half, begin);
  memcpy(set, begin, sizeof set);
  kz_enclosures_advance(plan, KZ_KEEP_FRAME, SETS, set);
  quad end[2 * SETS][2];
  for (int i = 0; i < 2 * SETS; i++) {
    end[i][0] = (quad)begin[i / 2].theta[0] + (quad)corner[i % 2][0] * half;
    end[i][1] = (quad)begin[i / 2].velocity[0] + (quad)corner[i % 2][1] * half;
  }
  move_truly(pendulum, 2 * SETS, 1, end);
  for (int i = 0; i < SETS; i++) {
    double z[2][2];
    if (!isfinite(set[i].reach[0])) continue;
    for (int c = 0; c < 2; c++) {
      place_of(end[2 * i + c], &set[i], z[c]);
      for (int j = 0; j < 2; j++)
        largest = fmax(largest, fabs(z[c][j] - corner[c][j] * half) / (set[i].reach[j] - half));
    }
    for (int j = 0; j < 2; j++)
      *bent = fmax(*bent, fabs(z[0][j] - z[1][j] - (j == 0) * 2 * half) / (2 * half * set[i].jacobian_error[j][0]));
  }
  return largest;
}

/* Sets whose frame is kept: all starts lie inside, and outside once the bound of a lemma is cut. Each is seen by sets
 * of a size at which it counts. */
TEST(each_bound_is_needed) {
  static const struct {
    int lemma;
    int32_t precision;
    double half, left;
  } cases[] = {{3, KZ_ENCLOSE_DOUBLES, 1e-17, 0},
               {3, KZ_ENCLOSE_PAIRS, 1e-32, 0},
               {4, KZ_ENCLOSE_TRIPLES, 1e-17, 0},
               {5, KZ_ENCLOSE_DOUBLES, 1e-2, 0.3},
               {6, KZ_ENCLOSE_DOUBLES, 1e-2, 0.1}};
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  for (int i = 0; i < 5; i++) {
    kz_enclosure_tables *plan = plan_for(&pendulum, cases[i].precision, 2);
    for (int is_cut = 0; is_cut < 2; is_cut++) {
      double bent;
      if (is_cut) enclosure_cut(plan, cases[i].lemma, cases[i].left);
      srand(3);
      const double share = share_of_growth(&pendulum, plan, cases[i].half, &bent);
      assert_true(((cases[i].lemma == 4 ? bent : share) < 1) == !is_cut); /* two corners share their centre's error */
    }
    kz_enclosure_tables_free(plan);
  }
}

TEST(kept_frames_hold_the_motion) {
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_enclosure_tables *plan = plan_for(&pendulum, KZ_ENCLOSE_DOUBLES, 2);
  srand(3);
  for (double half = 1e-2; half > 1e-14; half *= 1e-5) {
    double bent;
    assert_true(share_of_growth(&pendulum, plan, half, &bent) < 1 && bent < 1);
  }
  kz_enclosure_tables_free(plan);
}
