/* Labels that are called decided, against quad precision, judged by circles around the strobe points and not by
 * trapping regions. Starts are chosen against the method: 1e-16 to 1e-8 rad from boundaries, found by bisection, of
 * pendulums beside folds and doublings, where a saddle is near, and where orbits linger; those that version 0.2.0
 * labelled wrongly; and any starts of other drives and after ramps (releases in quads: unit/dynamics/released.c).
 * KAPITZA_EXTENSIVE=1: more boundaries, 4000 cells and 2000 after a ramp. */
#include "../tools/reference.h"
#include "../tools/test.h"

#include "../tools/explored.h"
#include "kapitza/dynamics_release.h"

#include <stdbool.h>

enum {
  CLOSE = 9,
  MAX_PERIODS = 2000,
  FOLLOWED = 600,
  STEPS = 26,
  BISECTIONS = 56,
  DRIVES = 4,
  TERMS = 7,
  AT_ONCE = 20,
  MOST = 1000
};

static const kz_pendulum pendulums[] = {
    {0.1, 0.1, 0.3997},
    {0.1, 0.1, 0.6902925389207152},
    {0.3, 0.05, 0.17986044278083926},
    {-0.05, 0.08, 0.5133467257604597},
    {1.0 / 121, 1.0 / 55, 0.46},
    {1.0 / 121, 1.0 / 55, 0.52},
    {0.1, 0.1, 0.39965146083203706},
};

/* Starts that 0.2.0 labelled wrongly: beside folds, where a saddle lies nearer to the attractor than 0.03 rad, and two
 * that linger and so repeat the same error of a step period after period. */
static const struct {
  size_t pendulum;
  double theta, velocity;
} once_wrong[] = {
    {0, -2.1185540809750316, 0.8669870372823835},
    {1, -0.8627010903637058, 1.0431368818445625},
    {2, 2.0497217392915363, -1.8212938083385788},
    {3, 2.722867269927126, -0.1466870505356177},
    {5, 0.6880087911361648, -0.682},
    {5, -0.20420352248333656, -0.198},
};

static kz_pendulum drive_of(int which) {
  kz_pendulum p = {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3};
  switch (which) {
    case 0: /* tilted by 5 degrees */
      p.harmonics = 1, p.unmirrored = 1;
      p.vertical[0][0] = p.m * cos(M_PI / 36) - p.m, p.horizontal[0][0] = p.m * sin(M_PI / 36);
      break;
    case 1: /* the first terms of a square wave */
      p.harmonics = TERMS;
      for (int j = 1; j <= TERMS; j += 2)
        p.vertical[j - 1][0] = p.m * 4 / (M_PI * j) * (j % 4 == 1 ? 1 : -1) - (j == 1 ? p.m : 0);
      break;
    case 2: /* two frequencies */
      p.harmonics = 2, p.vertical[1][0] = 0.1, p.vertical[1][1] = -0.05;
      break;
    default:
      p.k = 0.25, p.beta = 0.1, p.unmirrored = 1, p.torque = 0.1;
  }
  return p;
}

/* By the reference: where n starts end after their release; 0 = nowhere within so many periods. */
static void certain_truth(kz_dynamics *d, const kz_pendulum *p, int n, const kz_start *start, int64_t periods,
                          int32_t *label) {
  static kz_start released[MOST];
  static kz_reference_state late[MOST];
  static int place[MOST];
  int left = n;
  memcpy(released, start, (size_t)n * sizeof *start);
  kz_dynamics_begin(d, KZ_LEVEL_QUAD, n, released);
  for (int i = 0; i < n; i++) {
    const double low[2] = {released[i].theta[1], released[i].velocity[1]};
    kz_reference_start(1, released[i].theta, released[i].velocity, low, late + i);
    label[i] = 0, place[i] = i;
  }
  for (int64_t period = 0; period < periods && left > 0; period += AT_ONCE) {
    int still = 0;
    kz_reference_advance(p, STEPS, left, AT_ONCE, late);
    for (int i = 0; i < left; i++) {
      double theta, velocity;
      int64_t turns;
      kz_reference_read(1, late + i, &theta, &velocity, &turns);
      label[place[i]] = circle_at(d, theta, velocity);
      if (label[place[i]] > 0) continue;
      late[still] = late[i];
      place[still++] = place[i];
    }
    left = still;
  }
}

/* All levels, one after the other; decision [n]. */
static void certain_decide(kz_dynamics *d, int n, const kz_start *start, kz_decision *decision) {
  static kz_start some[MOST];
  static kz_decision found[MOST];
  static int place[MOST];
  int left = n;
  for (int i = 0; i < n; i++) place[i] = i;
  for (int32_t level = KZ_LEVEL_DOUBLE; level < KZ_LEVELS && left > 0; level++) {
    const kz_label_precision precision = {.level = (kz_precision)level,
                                          .before = (kz_precision)(level > 0 ? level - 1 : 0)};
    int still = 0;
    for (int i = 0; i < left; i++) some[i] = start[place[i]];
    kz_dynamics_begin(d, precision.level, left, some);
    kz_dynamics_label(d, &precision, left, some, MAX_PERIODS, found);
    for (int i = 0; i < left; i++) {
      decision[place[i]] = found[i];
      decision[place[i]].end.next = (uint8_t)level; /* the one that decides */
      if (found[i].end.label == KZ_DOUBTFUL) place[still++] = place[i];
    }
    left = still;
  }
}

typedef struct {
  int decided, wrong, by_level[KZ_LEVELS];
} counts;

/* Counts decided labels of starts; those whose end quad precision does not know are left out if `periods` are few. */
static void certain_judge(kz_dynamics *d, const kz_pendulum *p, int n, const kz_start *start, int64_t periods,
                          counts *c) {
  static kz_decision decision[MOST];
  static int32_t label[MOST];
  certain_decide(d, n, start, decision);
  certain_truth(d, p, n, start, periods, label);
  for (int i = 0; i < n; i++) {
    if (decision[i].end.label <= 0 || (label[i] == 0 && periods < MAX_PERIODS)) continue;
    c->decided++;
    c->by_level[decision[i].end.next]++;
    c->wrong += decision[i].end.label != label[i];
  }
}

static void certain_show(const char *name, size_t which, const counts *c) {
  print_message("%s %d: %d of %d decided wrongly; by level", name, (int)which, c->wrong, c->decided);
  for (int level = 0; level < KZ_LEVELS; level++) print_message(" %d", c->by_level[level]);
  print_message("\n");
}

/* Where a state ends without regard to errors. */
static int32_t end_of(kz_dynamics *d, const double state[2]) {
  double x[2] = {state[0], state[1]};
  int32_t label;
  int64_t periods;
  kz_dynamics_follow(d, KZ_FOLLOW_DIRECT, 1, MAX_PERIODS, x, &label, &periods, NULL);
  return label;
}

/* A boundary between two states (half-turns, velocity) with different ends. */
static void certain_bisect(kz_dynamics *d, double a[2], const double b[2]) {
  double other[2] = {b[0], b[1]};
  const int32_t own = end_of(d, a);
  for (int i = 0; i < BISECTIONS; i++) {
    const double middle[2] = {a[0] + (other[0] - a[0]) / 2, a[1] + (other[1] - a[1]) / 2};
    memcpy(end_of(d, middle) == own ? a : other, middle, sizeof middle);
  }
}

TEST(test_decided_beside_boundaries_is_right) {
  enum { PAIRS = 4000 };
  static double x[2 * PAIRS];
  const int boundaries = getenv("KAPITZA_EXTENSIVE") ? 40 : 1;
  for (size_t p = 0; p < sizeof pendulums / sizeof pendulums[0]; p++) {
    int found = 0, of_this = 0;
    counts all = {0}, known = {0};
    kz_dynamics *d = explored_pendulum(pendulums + p, fine_numerics(), 1, 0, 4.0);
    kz_dynamics_starts(&WINDOW, 11 + (int64_t)p, PAIRS, x);
    for (int i = 0; i + 1 < PAIRS && found < boundaries; i += 2) {
      kz_start start[CLOSE];
      if (end_of(d, x + 2 * i) == end_of(d, x + 2 * i + 2)) continue;
      certain_bisect(d, x + 2 * i, x + 2 * i + 2);
      found++;
      for (int e = 0; e < CLOSE; e++)
        start[e] = (kz_start){.theta = {M_PI * x[2 * i] + pow(10, e - 16)}, .velocity = {x[2 * i + 1]}};
      certain_judge(d, pendulums + p, CLOSE, start, FOLLOWED, &all);
    }
    for (size_t i = 0; i < sizeof once_wrong / sizeof *once_wrong; i++) {
      const kz_start start = {.theta = {once_wrong[i].theta}, .velocity = {once_wrong[i].velocity}};
      if (once_wrong[i].pendulum != p) continue;
      certain_judge(d, pendulums + p, 1, &start, FOLLOWED, &known);
      of_this++;
    }
    certain_show("pendulum", p, &all);
    assert_int_equal(all.wrong + known.wrong, 0);
    assert_int_equal(known.decided, of_this);
    assert_true(all.decided > 0);
    kz_dynamics_free(d);
  }
}

/* Labels given before at coarser levels change no decision: ranks with other tiles, and resumed runs, agree. */
TEST(test_decisions_have_no_history) {
  enum { N = 64 };
  double x[2 * N];
  kz_start start[N];
  kz_decision first[N], decision[2][N];
  kz_dynamics_starts(&WINDOW, 5, N, x);
  for (int i = 0; i < N; i++) start[i] = (kz_start){.theta = {M_PI * x[2 * i]}, .velocity = {x[2 * i + 1]}};
  for (int again = 0; again < 2; again++) {
    kz_dynamics *d = explored_pendulum(&pendulums[4], fine_numerics(), 1, 0, 3);
    kz_dynamics_regions(d, 200, 3);
    if (again)
      kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_PAIRS_16, .before = KZ_LEVEL_FINE}, N, start,
                        MAX_PERIODS, first);
    kz_dynamics_label(d, &(kz_label_precision){.level = KZ_LEVEL_PAIRS_20, .before = KZ_LEVEL_PAIRS_16}, N, start,
                      MAX_PERIODS, decision[again]);
    kz_dynamics_free(d);
  }
  for (int i = 0; i < N; i++) {
    assert_int_equal(decision[0][i].end.label, decision[1][i].end.label);
    if (decision[0][i].end.label != KZ_DOUBTFUL) assert_true(decision[0][i].error == decision[1][i].error);
  }
}

/* No decided label of some starts (MOST in an extensive run) is wrong, and most are decided. */
static void certain_check(const char *name, int which, kz_dynamics *d, const kz_pendulum *p, int some) {
  static double x[2 * MOST];
  static kz_start start[MOST];
  const int n = getenv("KAPITZA_EXTENSIVE") ? MOST : some;
  counts all = {0};
  kz_dynamics_starts(&WINDOW, 5 + which, MOST, x);
  for (int i = 0; i < n; i++) start[i] = (kz_start){.theta = {M_PI * x[2 * i]}, .velocity = {x[2 * i + 1]}};
  certain_judge(d, p, n, start, MAX_PERIODS, &all);
  certain_show(name, (size_t)which, &all);
  assert_int_equal(all.wrong, 0);
  assert_true(10 * all.decided >= 8 * n);
}

TEST(test_decided_under_other_drives_is_right) {
  for (int which = 0; which < DRIVES; which++) {
    const kz_pendulum p = drive_of(which);
    kz_dynamics *d = explored_pendulum(&p, fine_numerics(), 1, 0, 4.0);
    certain_check("drive", which, d, &p, 5);
    kz_dynamics_free(d);
  }
}

static const kz_pendulum FIG12 = {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3};

/* A release in double precision lies within the error that comes with it. */
TEST(test_releases_know_their_errors) {
  static const kz_release releases[] = {{.phase = 2, .damping = 1.0 / 55, .drive = 1},
                                        {.periods = 4.5, .damping = 0.002, .drive = 1},
                                        {.phase = 0.5, .periods = 3, .damping = 1.0 / 55, .drive = 0.2}};
  kz_dynamics *d = explored_pendulum(&FIG12, fine_numerics(), 1, 0, 4.0);
  for (size_t which = 0; which < sizeof releases / sizeof *releases; which++) {
    kz_start fine = {.theta = {0.7}, .velocity = {-0.4}}, plain = fine;
    kz_dynamics_set_release(d, releases + which);
    kz_dynamics_begin(d, KZ_LEVEL_QUAD, 1, &fine);
    kz_dynamics_begin(d, KZ_LEVEL_DOUBLE, 1, &plain);
    const double error = sqrt(plain.error[0] + plain.error[2]),
                 off = hypot(remainder(fine.theta[0] - plain.theta[0], 2 * M_PI), fine.velocity[0] - plain.velocity[0]);
    assert_int_equal(plain.periods, fine.periods);
    assert_true(error < 1e-10 && off < error && fine.error[0] + fine.error[2] < 1e-54);
  }
  kz_dynamics_free(d);
}

TEST(test_decided_after_a_ramp_is_right) {
  const double periods = getenv("KAPITZA_EXTENSIVE") ? 100 : 30;
  const kz_release ramps[] = {{.periods = periods, .damping = 0.004, .drive = 1},
                              {.periods = periods, .damping = 1.0 / 55, .drive = 0.6}};
  kz_dynamics *d = explored_pendulum(&FIG12, fine_numerics(), 1, 0, 4.0);
  for (int which = 0; which < 2; which++) {
    kz_dynamics_set_release(d, ramps + which);
    certain_check("ramp", which, d, &FIG12, 3);
  }
  kz_dynamics_free(d);
}
