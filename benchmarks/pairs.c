/* Pairs of doubles by Taylor series beside pairs by splitting: which carries an orbit through a period in less time, at
 * the same error?
 *
 * stdout: for Fig. 12's pendulum and each error of a period a line "row ERROR SPLITTING_NS TAYLOR_NS RATIO STEPS ORDER
 * PAIRS": nanoseconds for a state and a period of both, of 64 states with speeds up to 2.5; and of the cheapest series
 * its steps a period, its order, and how many of its orders are pairs. The recurrence is that of every orbit
 * (taylor/motion.inc), in pairs and, in the orders that need no more digits, in doubles. Processor time, the shortest
 * of five. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../tests/tools/reference.h"
#include "enclosure/operations.h"
#include "taylor/triples.h"

enum { N = KZ_LANES, PARTS = 2, MOST = KZ_ORDER_PAIRS, REPEATS = 5, PERIODS = 40 };
static const double fastest = 2.5;

/* tests/unit/pairs.f90. */
void *kz_test_pairs_create(const kz_pendulum *pendulum, double tolerance, double fastest, double *error);
void kz_test_pairs_free(void *pairs);
void kz_test_pairs_advance(const void *pairs, int64_t n, int64_t periods, double *half_turns, double *velocity,
                           int64_t *turns);

/* Coefficients of velocity, sine or cosine: those below `pairs` are pairs, whose high parts are doubles too. */
typedef struct {
  pair fine[MOST][PARTS];
  vector coarse[MOST][PARTS];
} coefficients;

typedef struct {
  coefficients w, s, c;
} series;

typedef struct {
  int steps, order, pairs;
} shape;

#define EACH for (int p = 0; p < PARTS; p++)

KZ_INLINE void put_coarse(vector x, int64_t n, int p, coefficients *to) {
  to->coarse[n][p] = x;
}

KZ_INLINE void put_fine(pair x, int64_t n, int p, coefficients *to) {
  to->fine[n][p] = x;
  to->coarse[n][p] = x.high;
}

KZ_INLINE vector scaled_coarse(vector x, vector factor) {
  return x * factor;
}

KZ_INLINE pair scaled_fine(pair x, pair factor) {
  return multiply_pairs(quick_two_sum(x.high, x.low), factor);
}

#define CONSTANT(sign, c) KZ_OF_LEVEL(KZ_CONSTANT_)(sign(c).high, sign(c).low, 0)
#define FACTOR_along(i) CONSTANT(, speed->along[first + (i)])
#define FACTOR_across(i) CONSTANT(, speed->across[first + (i)])
#define FACTOR_w(i) x->w.KZ_LEVEL[i][p]
#define UNIT_w inverse
#define UNIT_s step
#define UNIT_c step
#define KZ_NEXT KZ_OF_LEVEL(next_)
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, series *x
#define KZ_SUM(total) \
  KZ_OF_LEVEL(number_) total[PARTS] = {KZ_OF_LEVEL(KZ_CONSTANT_)(0, 0, 0), KZ_OF_LEVEL(KZ_CONSTANT_)(0, 0, 0)}
#define KZ_TERMS for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(total, a, b) EACH KZ_OF_LEVEL(accumulate_)(&total[p], x -> b.KZ_LEVEL[n - i][p], FACTOR_##a(i))
#define KZ_DAMP(total) EACH KZ_OF_LEVEL(accumulate_)(&total[p], x -> w.KZ_LEVEL[n][p], CONSTANT(, speed->damping))
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(total) \
  EACH KZ_OF_LEVEL(accumulate_)(&total[p], KZ_OF_LEVEL(KZ_CONSTANT_)(-1, 0, 0), CONSTANT(, speed -> push))
#define KZ_SET(name, sign, total) \
  EACH KZ_OF_LEVEL(put_)(KZ_OF_LEVEL(scaled_)(total[p], CONSTANT(sign, speed -> UNIT_##name[n])), n + 1, p, &x->name)

#define KZ_LEVEL fine
#include "taylor/motion.inc"
#define KZ_LEVEL coarse
#include "taylor/motion.inc"

/* theta (rad), velocity, sine and cosine of the states of PARTS vectors. */
typedef struct {
  pair theta[PARTS], w[PARTS], s[PARTS], c[PARTS];
} place;

/* The sum of the orders from 1 on; `integrated`: each times h / (n + 1). */
KZ_INLINE pair sum_of(const kz_speed_class *speed, shape size, const coefficients *x, int p, bool integrated) {
  vector small = broadcast_value(0);
  for (int n = size.order - 1; n >= size.pairs; n--)
    small += x->coarse[n][p] * (integrated ? broadcast_value(speed->step[n].high) : broadcast_value(1));
  pair total = {small, broadcast_value(0)};
  for (int n = size.pairs - 1; n >= 1; n--) {
    const pair unit = {broadcast_value(speed->step[n].high), broadcast_value(speed->step[n].low)};
    total = sum_unnormalised(total, integrated ? product_unnormalised(x->fine[n][p], unit) : x->fine[n][p]);
  }
  return quick_two_sum(total.high, total.low);
}

static void pairs_follow(const kz_speed_class *speed, shape size, int64_t periods, place *at) {
  static _Alignas(64) series x;
  const pair h = {broadcast_value(speed->step[0].high), broadcast_value(speed->step[0].low)};
  for (int64_t step = 0; step < periods * size.steps; step++) {
    const int32_t first = (int32_t)(step % size.steps) * speed->order;
    EACH {
      put_fine(at->w[p], 0, p, &x.w);
      put_fine(at->s[p], 0, p, &x.s);
      put_fine(at->c[p], 0, p, &x.c);
    }
    for (int n = 0; n + 1 < size.pairs; n++) next_fine(speed, first, &x, n);
    for (int n = size.pairs - 1; n + 1 < size.order; n++) next_coarse(speed, first, &x, n);
    EACH {
      at->theta[p] =
          add_pairs(add_pairs(at->theta[p], multiply_pairs(at->w[p], h)), sum_of(speed, size, &x.w, p, true));
      at->w[p] = add_pairs(at->w[p], sum_of(speed, size, &x.w, p, false));
      at->s[p] = add_pairs(at->s[p], sum_of(speed, size, &x.s, p, false));
      at->c[p] = add_pairs(at->c[p], sum_of(speed, size, &x.c, p, false));
    }
  }
}

/* Starts with their images after a period, and their sines and cosines, in quad precision. */
typedef struct {
  __float128 start[N][2], image[N][2];
  place at[N / (PARTS * LANES)];
} probes;

static void pairs_put(__float128 value, pair *x, int lane) {
  x->high[lane] = (double)value;
  x->low[lane] = (double)(value - (double)value);
}

/* Sine and cosine by their series, in quad precision. */
static void pairs_circle(__float128 theta, __float128 *sine, __float128 *cosine) {
  __float128 term = 1;
  *sine = 0, *cosine = 1;
  for (int n = 1; n < 60; n++) {
    term *= theta / n;
    *(n % 2 ? sine : cosine) += n % 4 < 2 ? term : -term;
  }
}

static void make_probes(const kz_pendulum *pendulum, probes *p) {
  kz_reference_state state[N];
  double theta[N], velocity[N];
  for (int i = 0; i < N; i++) {
    theta[i] = 2 * M_PI * (fmod(0.5 + 0.7548776662466927 * i, 1) - 0.5);
    velocity[i] = 2 * fastest * (fmod(0.5 + 0.5698402909980532 * i, 1) - 0.5);
  }
  kz_reference_start(N, theta, velocity, NULL, state);
  memset(p, 0, sizeof *p);
  for (int i = 0; i < N; i++) memcpy(p->start[i], state[i].quads, sizeof p->start[i]);
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, N, 1, state);
  for (int i = 0; i < N; i++) {
    place *at = &p->at[i / (PARTS * LANES)];
    const int part = i / LANES % PARTS, lane = i % LANES;
    __float128 sine, cosine;
    memcpy(p->image[i], state[i].quads, sizeof p->image[i]);
    pairs_circle(p->start[i][0], &sine, &cosine);
    pairs_put(p->start[i][0], &at->theta[part], lane);
    pairs_put(p->start[i][1], &at->w[part], lane);
    pairs_put(sine, &at->s[part], lane);
    pairs_put(cosine, &at->c[part], lane);
  }
}

static double error_of(const kz_speed_class *speed, shape size, const probes *p) {
  const double two_pi[3] = KZ_TWO_PI;
  double largest = 0;
  for (int group = 0; group < N / (PARTS * LANES); group++) {
    place at = p->at[group];
    pairs_follow(speed, size, 1, &at);
    for (int i = 0; i < PARTS * LANES; i++) {
      const int part = i / LANES, lane = i % LANES;
      const __float128 *image = p->image[group * PARTS * LANES + i];
      __float128 off = (__float128)at.theta[part].high[lane] + at.theta[part].low[lane] - image[0];
      const double turns = rint((double)off / two_pi[0]);
      off -= turns * ((__float128)two_pi[0] + two_pi[1] + two_pi[2]);
      const double v = (double)((__float128)at.w[part].high[lane] + at.w[part].low[lane] - image[1]);
      largest = fmax(largest, hypot((double)off, v));
    }
  }
  return isfinite(largest) ? largest : INFINITY;
}

/* The constants of so many steps; NULL: no memory. */
static kz_speed_class *steps_of(const kz_pendulum *pendulum, int n) {
  kz_speed_class *created = calloc(1, sizeof *created + 2 * (size_t)(n * MOST) * sizeof *created->along);
  if (!created) return NULL;
  created->across = created->along + n * MOST;
  created->has_across = pendulum->unmirrored;
  created->n_steps = n;
  created->order = MOST;
  kz_speed_class_set_constants(pendulum, created);
  return created;
}

static double pairs_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Nanoseconds for a state and a period. */
static double time_taylor(const kz_speed_class *speed, shape size, const probes *p) {
  double best = INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    const double begun = pairs_now();
    for (int group = 0; group < N / (PARTS * LANES); group++) {
      place at = p->at[group];
      pairs_follow(speed, size, PERIODS, &at);
    }
    best = fmin(best, pairs_now() - begun);
  }
  return 1e9 * best / N / PERIODS;
}

static double time_splitting(const void *pairs, const probes *p) {
  double best = INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    double half_turns[2 * N], velocity[2 * N];
    int64_t turns[N] = {0};
    for (int i = 0; i < N; i++) {
      half_turns[2 * i] = (double)p->start[i][0] / M_PI;
      velocity[2 * i] = (double)p->start[i][1];
      half_turns[2 * i + 1] = velocity[2 * i + 1] = 0;
    }
    const double begun = pairs_now();
    kz_test_pairs_advance(pairs, N, PERIODS, half_turns, velocity, turns);
    best = fmin(best, pairs_now() - begun);
  }
  return 1e9 * best / N / PERIODS;
}

/* Least *number, a part of `size`, with which a period's error is small enough; false: none up to `most`. */
static bool pairs_lower(const kz_speed_class *speed, shape *size, int *number, int most, double tolerance,
                        const probes *p) {
  int low = 2, high = most + 1;
  while (low < high) {
    *number = (low + high) / 2;
    if (error_of(speed, *size, p) <= tolerance)
      high = *number;
    else
      low = *number + 1;
  }
  *number = low;
  return low <= most;
}

/* The cheapest series whose error is small enough; its nanoseconds, INFINITY: none. */
static double pairs_cheapest(const kz_pendulum *pendulum, double tolerance, const probes *p, shape *best) {
  enum { FEWEST = 8, MOST_STEPS = 64, STRIDE = 4 };
  double least = INFINITY;
  for (int n = FEWEST; n <= MOST_STEPS; n += STRIDE) {
    kz_speed_class *speed = steps_of(pendulum, n);
    if (!speed) return INFINITY;
    shape size = {n, MOST, MOST};
    int order = MOST;
    for (; order > 2 && error_of(speed, (shape){n, order, order}, p) <= tolerance; order--)
      size.order = size.pairs = order;
    if (order < MOST && pairs_lower(speed, &size, &size.pairs, size.order, tolerance, p)) {
      const double ns = time_taylor(speed, size, p);
      if (ns < least) *best = size;
      least = fmin(least, ns);
    }
    free(speed);
  }
  return least;
}

int main(void) {
  static const double tolerances[] = {1e-16, 1e-18, 1e-20, 1e-22, 1e-24, 1e-26, 1e-28};
  static const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  static probes p;
  make_probes(&pendulum, &p);
  for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
    double error;
    shape best = {0};
    void *pairs = kz_test_pairs_create(&pendulum, tolerances[i], fastest, &error);
    if (!pairs) return 1;
    const double splitting = time_splitting(pairs, &p), taylor = pairs_cheapest(&pendulum, tolerances[i], &p, &best);
    printf("row %g %.0f %.0f %.2f %d %d %d\n", tolerances[i], splitting, taylor, taylor / splitting, best.steps,
           best.order, best.pairs);
    kz_test_pairs_free(pairs);
  }
  return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
