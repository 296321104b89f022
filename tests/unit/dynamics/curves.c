/* Curves of bifurcations over Blackburn's plane against the linear equation, the flutter table, and physics. */
#include "../../tools/test.h"

#include <math.h>
#include <string.h>

#include "kapitza/dynamics_trace.h"
#include "kapitza/kernel.h"

static const double PI = 3.14159265358979323846;

/* Omega = 3 + 27 x, epsilon = 0.8 y, Q = 5. */
static bool curves_blackburn(const void *context, const double place[2], kz_pendulum *pendulum) {
  (void)context;
  const double omega = 3 + 27 * place[0];
  *pendulum = (kz_pendulum){1 / (omega * omega), 1 / (5 * omega), 0.8 * place[1]};
  return true;
}
static const kz_plane PLANE = {
    .pendulum = curves_blackburn, .low = {-0.06, -0.004}, .high = {1.06, 1.06}, .steps = 96, .mirrored = 1};
static const double UP[2] = {0, 1};

/* Omega; birth of flutter, loss of its symmetry, its doubling (docs/validation/studies.md). */
static const double FLUTTER[][4] = {
    {5, 0.521937424, 0.603384245, 0.612281},  {7, 0.488875356, 0.577613876, 0.587068},
    {9, 0.475159217, 0.567126433, 0.576816},  {11, 0.46819030239, 0.561845642631, 0.571655778},
    {15, 0.461651232, 0.556920385, 0.566844}, {20, 0.458316643, 0.554420006, 0.564402},
    {30, 0.455932237, 0.552636805, 0.562660}};

/* The first value of epsilon on a branch upwards at which its multiplier is -1; the cycle moves there. */
static double next_flip(kz_cycle *cycle) {
  enum { MOST = 400, EVENTS = 8 };
  static kz_cycle row[MOST], event[EVENTS];
  const kz_cycle_kind kind = cycle->kind;
  kz_branch_end end;
  kz_cycle_continue(&PLANE, cycle, &(kz_branch_way){{0, 1}, 0.02, 0, MOST, EVENTS, 0}, row, event, &end);
  assert_true(end.rows > 3);
  for (int64_t i = 0; i < end.events; i++) {
    if (event[i].event != KZ_EVENT_FLIP) continue;
    *cycle = event[i];
    assert_memory_equal(&cycle->kind, &kind, sizeof kind);
    for (int p = kind.points; p < KZ_CURVE_POINTS; p++) assert_true(cycle->point[p][0] == 0 && cycle->point[p][1] == 0);
    return 0.8 * cycle->place[1];
  }
  return NAN;
}

/* Rest inverted at a place, or a cycle beside it. */
static kz_cycle rest_at(double x, double y) {
  return (kz_cycle){.kind = {1, 1, -1}, .place = {x, y}, .point = {{PI}}};
}

static void curves_move(kz_cycle *cycle, double by, const double vector[2]) {
  for (int i = 0; i < 2; i++) cycle->point[0][i] += by * vector[i];
}

/* On a vertical line: flutter is born out of inverted rest, loses its symmetry, and then doubles. */
TEST(test_flutter) {
  for (size_t i = 0; i < sizeof FLUTTER / sizeof FLUTTER[0]; i++) {
    kz_cycle cycle = rest_at((FLUTTER[i][0] - 3) / 27, 0.47 / 0.8);
    kz_normal_form form;
    assert_int_equal(kz_cycle_locate(&PLANE, &cycle, UP), 1);
    assert_true(fabs(0.8 * cycle.place[1] - FLUTTER[i][1]) < 5.1e-10);
    assert_int_equal(kz_cycle_form(&PLANE, &cycle, &form), 1);
    assert_true(form.coefficient > 0 && form.side[1] < 0); /* rest is stable below, and flutter attracts above */
    curves_move(&cycle, 0.02, form.vector);
    cycle.place[1] += 1e-4;
    cycle.kind = (kz_cycle_kind){-1, 1, -1, 1};
    assert_true(fabs(next_flip(&cycle) - FLUTTER[i][2]) < 5.1e-10);
    assert_int_equal(kz_cycle_form(&PLANE, &cycle, &form), 1);
    assert_true(form.coefficient > 0 && form.side[1] < 0);
    curves_move(&cycle, 0.02, form.vector);
    assert_int_equal(kz_curve_orbit(&PLANE, cycle.place, 2, 1, cycle.point[0]), 1);
    cycle.place[1] += 2e-5;
    cycle.kind = (kz_cycle_kind){1, 2, -1};
    assert_true(fabs(next_flip(&cycle) - FLUTTER[i][3]) < (fabs(FLUTTER[i][0] - 11) < 0.5 ? 5.1e-10 : 5.1e-7));
  }
}

/* At Omega = 20 a rotation of six periods is born at 0.3505459 and doubles 1.8e-5 above: its branches reach that. */
TEST(test_branches_of_a_fold) {
  enum { MOST = 400, EVENTS = 20 };
  kz_cycle fold = {.kind = {1, 6, 1, 2},
                   .place = {17.0 / 27, 0.35054538465 / 0.8},
                   .point = {{0.792497560880641, 0.408106903865102}}};
  double nearest = 1;
  static kz_cycle row[MOST], event[EVENTS];
  kz_branch_end end;
  assert_int_equal(kz_curve_orbit(&PLANE, fold.place, 2, 5, fold.point[0]), 1);
  assert_int_equal(kz_cycle_locate(&PLANE, &fold, UP), 1);
  assert_true(fabs(0.8 * fold.place[1] - 0.350545384650) < 1e-9);
  for (int side = -1; side <= 1; side += 2) {
    kz_cycle_continue(&PLANE, &fold, &(kz_branch_way){{0, 1}, 0.02, 0, MOST, EVENTS, side}, row, event, &end);
    for (int64_t i = 0; i < end.events; i++)
      if (event[i].event == KZ_EVENT_FLIP && event[i].place[1] > fold.place[1])
        nearest = fmin(nearest, 0.8 * (event[i].place[1] - fold.place[1]));
  }
  assert_true(1e-5 < nearest && nearest < 3e-5);
}

enum { TRACED = 300, SPECIAL = 4 };
static kz_curve_row traced[TRACED];
static kz_cycle special[SPECIAL];
static kz_branch_end curves_trace(const kz_plane *plane, const kz_cycle *seed, int32_t direction) {
  kz_branch_end end;
  kz_curve_trace(plane, seed, &(kz_branch_way){{0}, 0.02, 0, TRACED, SPECIAL, direction}, traced, special, &end);
  return end;
}

/* The whole curve of the birth: every point is one of the published map to 1e-11, and the tangent map there has the
 * multiplier -1. */
TEST(test_trace) {
  kz_cycle seed = rest_at(0.3, 0.47 / 0.8);
  assert_int_equal(kz_cycle_locate(&PLANE, &seed, UP), 1);
  const kz_branch_end end = curves_trace(&PLANE, &seed, 1);
  assert_true(end.rows > 20 && end.ending == KZ_TRACE_LEFT && end.events == 0);
  for (int64_t i = 0; i < end.rows; i++) {
    kz_pendulum pendulum;
    const kz_numerics fine = {.scheme = kz_scheme_find("split6"), .steps_per_period = 96};
    double theta = PI, velocity = 0, matrix[4];
    int64_t turns = 0;
    assert_true(curves_blackburn(NULL, traced[i].at.place, &pendulum));
    kz_flow *flow = kz_flow_create(&pendulum, &fine);
    kz_advance_tangent(flow, 1, 1, &theta, &velocity, &turns, matrix);
    kz_flow_free(flow);
    assert_true(fabs(matrix[0] + matrix[3] + 1 + exp(-2 * PI * pendulum.beta)) < 1e-11);
  }
}

/* k = 2.2 x - 0.6, beta = 0.1, m = 2 y: Butikov's plane. */
static bool curves_butikov(const void *context, const double place[2], kz_pendulum *pendulum) {
  (void)context;
  *pendulum = (kz_pendulum){2.2 * place[0] - 0.6, 0.1, 2 * place[1]};
  return true;
}

/* The doubling of a doubled rotation 1/3 in a band 2e-8 wide, where a cycle that is 1e-6 rad off is another one: each
 * row is the point that Newton's method finds beside it. */
TEST(test_trace_in_a_narrow_band) {
  const kz_plane plane = {
      .pendulum = curves_butikov, .low = {-0.06, -0.004}, .high = {1.06, 1.06}, .steps = 96, .mirrored = 1};
  kz_cycle seed = {.kind = {1, 6, -1, 2},
                   .place = {(0.6 - 0.5309297007299472) / 2.2, 1.2948761672834188 / 2},
                   .point = {{-0.13118270219777192, 0.10333998458147906}}};
  assert_int_equal(kz_curve_orbit(&plane, seed.place, 2, 5, seed.point[0]), 1);
  for (int direction = -1; direction <= 1; direction += 2) {
    const kz_branch_end end = curves_trace(&plane, &seed, direction);
    assert_true(end.rows > 10 && (end.ending == KZ_TRACE_THIN || end.ending == KZ_TRACE_LEFT) && end.events == 0);
    for (int64_t i = 0; i < end.rows; i++) {
      kz_cycle at = traced[i].at;
      assert_int_equal(kz_cycle_locate(&plane, &at, UP), 1);
      assert_true(traced[i].form.coefficient > 0 && fabs(at.place[1] - traced[i].at.place[1]) < 1e-11);
      for (int p = 0; p < 6; p++)
        for (int c = 0; c < 2; c++) assert_true(fabs(at.point[p][c] - traced[i].at.point[p][c]) < 1e-8);
    }
  }
}

/* The doubling of rotation 1/1 turns from supercritical to subcritical at Omega = 4.646: the place is a row with the
 * normal form 0, so that its sign between two rows is that of both. */
TEST(test_a_degenerate_point_is_a_row) {
  kz_cycle seed = {
      .kind = {1, 1, -1, 1}, .place = {(4.5976746 - 3) / 27, 0.5122515 / 0.8}, .point = {{2.9663819, 1.0799895}}};
  int64_t found = 0;
  assert_int_equal(kz_cycle_locate(&PLANE, &seed, UP), 1);
  for (int direction = -1; direction <= 1; direction += 2) {
    const kz_branch_end end = curves_trace(&PLANE, &seed, direction);
    for (int64_t i = 1; i < end.rows; i++)
      assert_true(traced[i - 1].form.coefficient * traced[i].form.coefficient >= 0);
    for (int64_t i = 0; i < end.rows && end.events == 1; i++)
      found +=
          traced[i].form.coefficient == 0 && !memcmp(traced[i].at.place, special[0].place, sizeof special[0].place);
    if (end.events == 1) assert_true(fabs(3 + 27 * special[0].place[0] - 4.6460513) < 1e-6);
  }
  assert_int_equal(found, 1);
}

/* Refused: a seed far from any curve, and a place without damping. */
TEST(test_refused) {
  const kz_cycle seed = rest_at(-0.12, 0.3);
  const kz_branch_end end = curves_trace(&PLANE, &seed, 1);
  assert_true(end.rows == 0 && end.ending == KZ_TRACE_NO_SEED);
}
