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

/* The first value of epsilon on a branch upwards at which its multiplier is -1; y moves there. */
static double next_flip(const kz_curve_kind *kind, double *y) {
  enum { MOST = 400, EVENTS = 8 };
  const int n = 2 * kind->points;
  static kz_branch_row row[MOST];
  kz_branch_event event[EVENTS];
  kz_branch_end end;
  kz_curve_branch(&PLANE, kind, y, &(kz_branch_way){{0, 1}, 0.02, 0, MOST, EVENTS, 0}, row, event, &end);
  assert_true(end.rows > 3);
  for (int64_t i = 0; i < end.events; i++) {
    if (event[i].what != KZ_EVENT_FLIP) continue;
    memcpy(y, event[i].y, (size_t)(n + 2) * sizeof *y);
    for (int c = n + 2; c < 2 * KZ_CURVE_POINTS + 2; c++) assert_true(event[i].y[c] == 0);
    return 0.8 * y[n + 1];
  }
  return NAN;
}

/* On a vertical line: flutter is born out of inverted rest, loses its symmetry, and then doubles. */
TEST(test_flutter) {
  const kz_curve_kind rest = {1, 1, -1, 0, 0}, symmetric = {-1, 1, -1, 1, 0}, pair = {1, 2, -1, 0, 0};
  for (size_t i = 0; i < sizeof FLUTTER / sizeof FLUTTER[0]; i++) {
    double y[4] = {PI, 0, (FLUTTER[i][0] - 3) / 27, 0.47 / 0.8}, child[6], form, side[2], vector[2];
    assert_int_equal(kz_curve_locate(&PLANE, &rest, y, UP), 1);
    assert_true(fabs(0.8 * y[3] - FLUTTER[i][1]) < 5.1e-10);
    assert_int_equal(kz_curve_form(&PLANE, &rest, y, &form, side, vector), 1);
    assert_true(form > 0 && side[1] < 0); /* rest is stable below, and flutter attracts above */
    y[0] += 0.02 * vector[0], y[1] += 0.02 * vector[1], y[3] += 1e-4;
    assert_true(fabs(next_flip(&symmetric, y) - FLUTTER[i][2]) < 5.1e-10);
    assert_int_equal(kz_curve_form(&PLANE, &symmetric, y, &form, side, vector), 1);
    assert_true(form > 0 && side[1] < 0);
    child[0] = y[0] + 0.02 * vector[0], child[1] = y[1] + 0.02 * vector[1];
    assert_int_equal(kz_curve_orbit(&PLANE, y + 2, 2, 1, child), 1);
    child[4] = y[2], child[5] = y[3] + 2e-5;
    assert_true(fabs(next_flip(&pair, child) - FLUTTER[i][3]) < (fabs(FLUTTER[i][0] - 11) < 0.5 ? 5.1e-10 : 5.1e-7));
  }
}

/* At Omega = 20 a rotation of six periods is born at 0.3505459 and doubles 1.8e-5 above: its branches reach that. */
TEST(test_branches_of_a_fold) {
  enum { MOST = 400, EVENTS = 20, N = 12 };
  const kz_curve_kind fold = {1, 6, 1, 2, 0};
  double y[N + 2] = {0.792497560880641, 0.408106903865102}, nearest = 1;
  static kz_branch_row row[MOST];
  kz_branch_event event[EVENTS];
  const double place[2] = {17.0 / 27, 0.35054538465 / 0.8};
  kz_branch_end end;
  assert_int_equal(kz_curve_orbit(&PLANE, place, 2, 6, y), 1);
  y[N] = place[0], y[N + 1] = place[1];
  assert_int_equal(kz_curve_locate(&PLANE, &fold, y, UP), 1);
  assert_true(fabs(0.8 * y[N + 1] - 0.350545384650) < 1e-9);
  for (int side = -1; side <= 1; side += 2) {
    kz_curve_branch(&PLANE, &fold, y, &(kz_branch_way){{0, 1}, 0.02, 0, MOST, EVENTS, side}, row, event, &end);
    for (int64_t i = 0; i < end.events; i++)
      if (event[i].what == KZ_EVENT_FLIP && event[i].y[N + 1] > y[N + 1])
        nearest = fmin(nearest, 0.8 * (event[i].y[N + 1] - y[N + 1]));
  }
  assert_true(1e-5 < nearest && nearest < 3e-5);
}

/* The whole birth curve: each point is one of the published map to 1e-11, its tangent map has multiplier -1. */
TEST(test_trace) {
  enum { MOST = 300 };
  const kz_curve_kind rest = {1, 1, -1, 0, 0};
  double seed[4] = {PI, 0, 0.3, 0.47 / 0.8}, row[MOST][10], special[4][5];
  int64_t specials;
  int32_t ending;
  assert_int_equal(kz_curve_locate(&PLANE, &rest, seed, UP), 1);
  const int64_t n = kz_curve_trace(&PLANE, &rest, seed, 1, 0.02, MOST, row[0], 4, special[0], &specials, &ending);
  assert_true(n > 20 && ending == KZ_TRACE_LEFT && specials == 0);
  for (int64_t i = 0; i < n; i++) {
    kz_pendulum pendulum;
    const kz_numerics fine = {.scheme = kz_scheme_find("split6"), .steps_per_period = 96};
    double theta = PI, velocity = 0, matrix[4];
    int64_t turns = 0;
    assert_true(curves_blackburn(NULL, row[i], &pendulum));
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
  enum { MOST = 300, N = 12, WIDTH = 8 + N };
  const kz_plane plane = {
      .pendulum = curves_butikov, .low = {-0.06, -0.004}, .high = {1.06, 1.06}, .steps = 96, .mirrored = 1};
  const kz_curve_kind doubling = {1, 6, -1, 2, 0};
  const double place[2] = {(0.6 - 0.5309297007299472) / 2.2, 1.2948761672834188 / 2};
  double seed[N + 2] = {-0.13118270219777192, 0.10333998458147906}, row[MOST][WIDTH], special[4][3 + N];
  int64_t specials;
  int32_t ending;
  assert_int_equal(kz_curve_orbit(&plane, place, 2, N / 2 - 1, seed), 1);
  seed[N] = place[0], seed[N + 1] = place[1];
  for (int direction = -1; direction <= 1; direction += 2) {
    const int64_t n =
        kz_curve_trace(&plane, &doubling, seed, direction, 0.02, MOST, row[0], 4, special[0], &specials, &ending);
    assert_true(n > 10 && (ending == KZ_TRACE_THIN || ending == KZ_TRACE_LEFT) && specials == 0);
    for (int64_t i = 0; i < n; i++) {
      double y[N + 2];
      memcpy(y, row[i] + 8, N * sizeof *y);
      memcpy(y + N, row[i], 2 * sizeof *y);
      assert_int_equal(kz_curve_locate(&plane, &doubling, y, UP), 1);
      assert_true(row[i][4] > 0 && fabs(y[N + 1] - row[i][1]) < 1e-11);
      for (int c = 0; c < N; c++) assert_true(fabs(y[c] - row[i][8 + c]) < 1e-8);
    }
  }
}

/* The doubling of rotation 1/1 turns from supercritical to subcritical at Omega = 4.646: the place is a row with the
 * normal form 0, so that its sign between two rows is that of both. */
TEST(test_a_degenerate_point_is_a_row) {
  enum { MOST = 300 };
  const kz_curve_kind rotation = {1, 1, -1, 1, 0};
  double seed[4] = {2.9663819, 1.0799895, (4.5976746 - 3) / 27, 0.5122515 / 0.8}, row[MOST][10], special[4][5];
  int64_t specials, found = 0;
  int32_t ending;
  assert_int_equal(kz_curve_locate(&PLANE, &rotation, seed, UP), 1);
  for (int direction = -1; direction <= 1; direction += 2) {
    const int64_t n =
        kz_curve_trace(&PLANE, &rotation, seed, direction, 0.02, MOST, row[0], 4, special[0], &specials, &ending);
    for (int64_t i = 1; i < n; i++) assert_true(row[i - 1][4] * row[i][4] >= 0);
    for (int64_t i = 0; i < n && specials == 1; i++)
      found += row[i][4] == 0 && row[i][0] == special[0][1] && row[i][1] == special[0][2];
    if (specials == 1) assert_true(fabs(3 + 27 * special[0][1] - 4.6460513) < 1e-6);
  }
  assert_int_equal(found, 1);
}

/* Refused: a seed far from any curve, and a place without damping. */
TEST(test_refused) {
  const kz_curve_kind rest = {1, 1, -1, 0, 0};
  double seed[4] = {PI, 0, -0.12, 0.3}, row[10], special[5];
  int64_t specials;
  int32_t ending;
  assert_int_equal(kz_curve_trace(&PLANE, &rest, seed, 1, 0.02, 1, row, 1, special, &specials, &ending), 0);
  assert_int_equal(ending, KZ_TRACE_NO_SEED);
}
