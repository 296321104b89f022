/* Labels that are called decided, against quad precision by other steps, judged by circles around the strobe points and not by trapping regions.
 * The starts are chosen against the method: 1e-16 to 1e-8 rad from boundaries, found by bisection, of pendulums beside folds and doublings, where
 * a saddle is near, and where orbits linger. KAPITZA_EXTENSIVE=1: more of them. */
#include "../tools/test.h"

#include "../tools/explored.h"

#include <stdbool.h>

enum { CLOSE = 9, MAX_PERIODS = 2000, FOLLOWED = 600, STEPS = 26, BISECTIONS = 56 };

static const kz_pendulum pendulums[] = {
    {0.1, 0.1, 0.3997},
    {0.1, 0.1, 0.6902925389207152},
    {0.3, 0.05, 0.17986044278083926},
    {-0.05, 0.08, 0.5133467257604597},
    {1.0 / 121, 1.0 / 55, 0.46},
    {1.0 / 121, 1.0 / 55, 0.52},
    {0.1, 0.1, 0.39965146083203706},
};

/* Quad precision: where n starts are after FOLLOWED periods. */
static void truth(const kz_dynamics *d, const kz_pendulum *pendulum, int n, const kz_start *start, int32_t *label) {
  kz_reference_state state[CLOSE];
  double theta[CLOSE], velocity[CLOSE];
  int64_t turns[CLOSE];
  for (int i = 0; i < n; i++) {
    theta[i] = start[i].theta[0];
    velocity[i] = start[i].velocity[0];
  }
  kz_reference_start(n, theta, velocity, NULL, state);
  kz_reference_advance(pendulum, STEPS, n, FOLLOWED, state);
  kz_reference_read(n, state, theta, velocity, turns);
  for (int i = 0; i < n; i++) label[i] = circle_at(d, theta[i], velocity[i]);
}

/* All levels, one after the other. */
static void decide(kz_dynamics *d, int n, const kz_start *start, kz_decision *decision) {
  for (int i = 0; i < n; i++)
    for (int32_t level = KZ_LEVEL_DOUBLE; level < KZ_LEVEL_ARBITRARY; level++) {
      kz_dynamics_label(d, level, level > 0 ? level - 1 : 0, 1, start + i, MAX_PERIODS, decision + i);
      if (decision[i].label != KZ_DOUBTFUL) break;
    }
}

/* Where a state ends without regard to errors. */
static int32_t end_of(kz_dynamics *d, const double state[2]) {
  double x[2] = {state[0], state[1]};
  int32_t label;
  int64_t periods;
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, 1, MAX_PERIODS, x, &label, &periods);
  return label;
}

/* A boundary between two states (half-turns, velocity) with different ends. */
static void bisect(kz_dynamics *d, double a[2], const double b[2]) {
  double other[2] = {b[0], b[1]};
  const int32_t own = end_of(d, a);
  for (int i = 0; i < BISECTIONS; i++) {
    const double middle[2] = {a[0] + (other[0] - a[0]) / 2, a[1] + (other[1] - a[1]) / 2};
    memcpy(end_of(d, middle) == own ? a : other, middle, sizeof middle);
  }
}

TEST(test_decided_is_right) {
  enum { PAIRS = 4000 };
  static double x[2 * PAIRS];
  const int boundaries = getenv("KAPITZA_EXTENSIVE") ? 40 : 1;
  for (size_t p = 0; p < sizeof pendulums / sizeof pendulums[0]; p++) {
    int found = 0, decided = 0, wrong = 0, by_level[KZ_LEVELS] = {0};
    kz_dynamics *d = explored_pendulum(pendulums + p, numerics(), 1, 0, 4.0);
    kz_dynamics_starts(&WINDOW, 11 + (int64_t)p, PAIRS, x);
    for (int i = 0; i + 1 < PAIRS && found < boundaries; i += 2) {
      kz_start start[CLOSE];
      kz_decision decision[CLOSE];
      int32_t label[CLOSE];
      if (end_of(d, x + 2 * i) == end_of(d, x + 2 * i + 2)) continue;
      bisect(d, x + 2 * i, x + 2 * i + 2);
      found++;
      for (int e = 0; e < CLOSE; e++)
        start[e] = (kz_start){.theta = {M_PI * x[2 * i] + pow(10, e - 16)}, .velocity = {x[2 * i + 1]}};
      decide(d, CLOSE, start, decision);
      truth(d, pendulums + p, CLOSE, start, label);
      for (int e = 0; e < CLOSE; e++) {
        if (decision[e].label <= 0 || label[e] == 0) continue;
        decided++;
        by_level[decision[e].level]++;
        wrong += decision[e].label != label[e];
      }
    }
    print_message("k %.4g damping %.4g m %.10g: %d of %d decided wrongly; by level", pendulums[p].k, pendulums[p].beta,
                  pendulums[p].m, wrong, decided);
    for (int level = 0; level < KZ_LEVEL_ARBITRARY; level++) print_message(" %d", by_level[level]);
    print_message("\n");
    assert_int_equal(wrong, 0);
    assert_true(decided > 0);
    kz_dynamics_free(d);
  }
}

/* What a process has labelled before at coarser levels changes no decision: ranks that met other tiles, and resumed runs, agree. */
TEST(test_decisions_have_no_history) {
  enum { N = 64 };
  double x[2 * N];
  kz_start start[N];
  kz_decision first[N], decision[2][N];
  kz_dynamics_starts(&WINDOW, 5, N, x);
  for (int i = 0; i < N; i++) start[i] = (kz_start){.theta = {M_PI * x[2 * i]}, .velocity = {x[2 * i + 1]}};
  for (int again = 0; again < 2; again++) {
    kz_dynamics *d = explored_pendulum(&pendulums[4], numerics(), 1, 0, 3);
    kz_dynamics_fine_regions(d, 200, 3);
    if (again) kz_dynamics_label(d, KZ_LEVEL_PAIRS_16, KZ_LEVEL_FINE, N, start, MAX_PERIODS, first);
    kz_dynamics_label(d, KZ_LEVEL_PAIRS_20, KZ_LEVEL_PAIRS_16, N, start, MAX_PERIODS, decision[again]);
    kz_dynamics_free(d);
  }
  for (int i = 0; i < N; i++) {
    assert_int_equal(decision[0][i].label, decision[1][i].label);
    if (decision[0][i].label != KZ_DOUBTFUL) assert_true(decision[0][i].error == decision[1][i].error);
  }
}
