/* Other drives - tilted, a square wave, two frequencies, a torque - and releases on a ramp. The reference against Taylor series in quad precision
 * that are written here; labels that are called decided against the reference (releases in quads: unit/dynamics/released.c).
 * KAPITZA_EXTENSIVE=1: 4000 cells and 2000 after a ramp, in place of some. */
#include "../tools/reference.h"
#include "../tools/test.h"

#include "../tools/explored.h"

#include <stdbool.h>

enum { MAX_PERIODS = 2000, ORDER = 28, STEPS = 64, DRIVES = 4, TERMS = 7, AT_ONCE = 10, MOST = 1000 };

typedef __float128 quad;
static const quad PI_QUAD = 3.14159265358979323846264338327950288Q;

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

/* Taylor coefficients of amplitude[0] cos j t + amplitude[1] sin j t about t, added. */
static void add_harmonic(int j, const double amplitude[2], double factor, quad t, quad *series) {
  quad s, c;
  sincosf128(j * t, &s, &c);
  quad value = factor * (amplitude[0] * c + amplitude[1] * s), slope = factor * j * (amplitude[1] * c - amplitude[0] * s);
  for (int n = 0; n <= ORDER; n++) {
    series[n] += value;
    const quad next = slope / (n + 1);
    slope = -value * j * j / (n + 1);
    value = next;
  }
}

/* One step of the series of theta, v, sin theta and cos theta. */
static void step(const kz_pendulum *p, quad t, quad *theta, quad *velocity) {
  quad x[ORDER + 2] = {*theta}, v[ORDER + 2] = {*velocity}, s[ORDER + 2], c[ORDER + 2], a[ORDER + 1] = {p->k},
                 b[ORDER + 1] = {0};
  const quad h = 2 * PI_QUAD / STEPS;
  add_harmonic(1, (const double[]){p->m, 0}, -1, t, a);
  for (int j = 1; j <= p->harmonics; j++) {
    add_harmonic(j, p->vertical[j - 1], -1, t, a);
    add_harmonic(j, p->horizontal[j - 1], 1, t, b);
  }
  sincosf128(*theta, s, c);
  for (int n = 0; n <= ORDER; n++) {
    quad rate = (n == 0 ? p->torque : 0) - p->beta * v[n], ds = 0, dc = 0;
    for (int i = 0; i <= n; i++) {
      rate += b[i] * c[n - i] - a[i] * s[n - i];
      ds += c[i] * v[n - i];
      dc -= s[i] * v[n - i];
    }
    x[n + 1] = v[n] / (n + 1), v[n + 1] = rate / (n + 1);
    s[n + 1] = ds / (n + 1), c[n + 1] = dc / (n + 1);
  }
  *theta = x[ORDER + 1], *velocity = v[ORDER + 1];
  for (int n = ORDER; n >= 0; n--) *theta = *theta * h + x[n], *velocity = *velocity * h + v[n];
}

TEST(test_reference_obeys_the_equation) {
  for (int which = 0; which < DRIVES; which++) {
    const kz_pendulum p = drive_of(which);
    const double theta = 0.7 - which, velocity = 0.3 * which - 0.5;
    quad x[2] = {theta, velocity}, y[2];
    kz_reference_state state;
    kz_reference_start(1, &theta, &velocity, NULL, &state);
    kz_reference_advance(&p, KZ_REFERENCE_STEPS, 1, 1, &state);
    memcpy(y, state.quads, sizeof y);
    for (int i = 0; i < STEPS; i++) step(&p, 2 * PI_QUAD * i / STEPS, x, x + 1);
    assert_true(fabs(remainder((double)(x[0] - y[0]), 2 * M_PI)) < 1e-28 && fabs((double)(x[1] - y[1])) < 1e-28);
  }
}

/* By the reference: where n states end; 0 = nowhere. */
static void truth(const kz_dynamics *d, const kz_pendulum *p, int n, const kz_reference_state *state, int32_t *label) {
  static kz_reference_state late[MOST];
  static int place[MOST];
  int left = n;
  for (int i = 0; i < n; i++) label[i] = 0, place[i] = i, late[i] = state[i];
  for (int period = 0; period < MAX_PERIODS && left > 0; period += AT_ONCE) {
    int still = 0;
    kz_reference_advance(p, 26, left, AT_ONCE, late);
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
static void decide(kz_dynamics *d, int n, const double *start, kz_decision *decision) {
  static kz_start some[MOST];
  static kz_decision found[MOST];
  static int place[MOST];
  int left = n;
  for (int i = 0; i < n; i++) place[i] = i;
  for (int32_t level = KZ_LEVEL_DOUBLE; level < KZ_LEVEL_ARBITRARY && left > 0; level++) {
    int still = 0;
    for (int i = 0; i < left; i++)
      some[i] = (kz_start){.theta = {M_PI * start[2 * place[i]]}, .velocity = {start[2 * place[i] + 1]}};
    kz_dynamics_release(d, level, left, some);
    kz_dynamics_label(d, level, level > 0 ? level - 1 : 0, left, some, MAX_PERIODS, found);
    for (int i = 0; i < left; i++) {
      decision[place[i]] = found[i];
      decision[place[i]].level = level;
      if (found[i].end.label == KZ_DOUBTFUL) place[still++] = place[i];
    }
    left = still;
  }
}

/* Labels n starts of a pendulum after a release: none of the decided ones is wrong. */
static void check(int which, kz_dynamics *d, const kz_pendulum *p, int n) {
  static double start[2 * MOST];
  static kz_reference_state state[MOST];
  static kz_start released[MOST];
  static kz_decision decision[MOST];
  static int32_t end[MOST];
  int wrong = 0, decided = 0, by_level[KZ_LEVELS] = {0};
  kz_dynamics_starts(&WINDOW, 5 + which, MOST, start);
  for (int i = 0; i < n; i++) released[i] = (kz_start){.theta = {M_PI * start[2 * i]}, .velocity = {start[2 * i + 1]}};
  kz_dynamics_release(d, KZ_LEVEL_QUAD, n, released);
  for (int i = 0; i < n; i++)
    kz_reference_start(1, released[i].theta, released[i].velocity,
                       (const double[]){released[i].theta[1], released[i].velocity[1]}, state + i);
  truth(d, p, n, state, end);
  decide(d, n, start, decision);
  for (int i = 0; i < n; i++) {
    if (decision[i].end.label <= 0) continue;
    decided++;
    by_level[decision[i].level]++;
    wrong += decision[i].end.label != end[i];
  }
  print_message("drive %d: %lld attractors, %d of %d decided wrongly, of %d; by level %d %d %d %d %d %d %d\n", which,
                (long long)kz_dynamics_count(d), wrong, decided, n, by_level[0], by_level[1], by_level[2], by_level[3],
                by_level[4], by_level[5], by_level[6]);
  assert_int_equal(wrong, 0);
  assert_true(10 * decided >= 8 * n);
}

TEST(test_decided_is_right) {
  for (int which = 0; which < DRIVES; which++) {
    const kz_pendulum p = drive_of(which);
    kz_dynamics *d = explored_pendulum(&p, numerics(), 1, 0, 4.0);
    check(which, d, &p, getenv("KAPITZA_EXTENSIVE") ? MOST : 5);
    kz_dynamics_free(d);
  }
}

static const kz_release releases[] = {{.phase = 2, .damping = 1.0 / 55, .drive = 1},
                                      {.periods = 4.5, .damping = 0.002, .drive = 1},
                                      {.phase = 0.5, .periods = 3, .damping = 1.0 / 55, .drive = 0.2}};

/* A release in double precision lies within the error that comes with it. */
TEST(test_releases_know_their_errors) {
  const kz_pendulum p = {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3};
  kz_dynamics *d = explored_pendulum(&p, numerics(), 1, 0, 4.0);
  for (size_t which = 0; which < sizeof releases / sizeof *releases; which++) {
    kz_start fine = {.theta = {0.7}, .velocity = {-0.4}}, plain = fine;
    kz_dynamics_set_release(d, releases + which);
    kz_dynamics_release(d, KZ_LEVEL_QUAD, 1, &fine);
    kz_dynamics_release(d, KZ_LEVEL_DOUBLE, 1, &plain);
    const double error = sqrt(plain.error[0] + plain.error[2]),
                 off = hypot(remainder(fine.theta[0] - plain.theta[0], 2 * M_PI), fine.velocity[0] - plain.velocity[0]);
    assert_int_equal(plain.periods, fine.periods);
    assert_true(error < 1e-10 && off < error && fine.error[0] + fine.error[2] < 1e-54);
  }
  kz_dynamics_free(d);
}

TEST(test_decided_after_a_ramp_is_right) {
  const kz_pendulum p = {.k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3};
  const double periods = getenv("KAPITZA_EXTENSIVE") ? 100 : 30;
  const kz_release ramps[] = {{.periods = periods, .damping = 0.004, .drive = 1},
                              {.periods = periods, .damping = 1.0 / 55, .drive = 0.6}};
  kz_dynamics *d = explored_pendulum(&p, numerics(), 1, 0, 4.0);
  for (int which = 0; which < 2; which++) {
    kz_dynamics_set_release(d, ramps + which);
    check(which, d, &p, getenv("KAPITZA_EXTENSIVE") ? MOST : 3);
  }
  kz_dynamics_free(d);
}
