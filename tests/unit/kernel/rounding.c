/* The rounding of a proof's step, (B1) .. (B3), against a machine on which the error of every operation is as large as
 * its lemma allows, all in one direction. It walks the operations of the step (motion.inc, the sums of centre_doubles.c
 * and centre_pairs.c) with sizes and errors in place of numbers. The bound holds for all sizes, and for each factor
 * there are sizes for which it fails once the factor is cut. */
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "enclosure/rounding.h"

enum { D = KZ_ENCLOSE_DOUBLES, PAIRS = KZ_ENCLOSE_PAIRS, TRIPLES = KZ_ENCLOSE_TRIPLES, P = KZ_ORDER_PAIRS };

/* |exact| <= size, |computed - exact| <= error. */
typedef struct {
  real size, error;
} number;

typedef struct {
  number sum;
  int products;
} total;

/* The lemmas of docs/explanation/bounds.md, by level, in units of u^(level + 1): a product, a sum, a constant; what a
 * number loses that is taken as one of the level below. */
static const real product[] = {1, 6, 39}, plus[] = {1, 3, 9}, constant[] = {1, 1, 1.01L}, part[] = {0, 1, 1.03L};
static const real first_part = 1.01L; /* First part of a triple taken as a double, in u */

static real sum_loss(int level, int n) {
  if (level == TRIPLES) return 4.1L * n * n * n + 25.0L * n * n + 42 * n + 29;
  return level == PAIRS ? n * n + 4 * n + 9 : n;
}

static real rounding_unit(int level) {
  return powl(0x1p-53L, level + 1);
}

/* Bound of coefficient n in a step of that precision. */
static int level_of(int precision, int n) {
  if (precision == TRIPLES) return n < KZ_COEFFICIENTS_TRIPLES ? TRIPLES : n < KZ_COEFFICIENTS_FINE ? PAIRS : D;
  return precision == PAIRS && n < KZ_COEFFICIENTS_PAIRS ? PAIRS : D;
}

static number of_constant(int level, real x) {
  return (number){x, constant[level] * rounding_unit(level) * x};
}

static number off_by(number x, real units, int level) {
  return (number){x.size, x.error + units * rounding_unit(level) * (x.size + x.error)};
}

static number sum_of(number x, number y, int level) {
  return off_by((number){x.size + y.size, x.error + y.error}, plus[level], level);
}

static number exact_product(number x, number y) {
  return (number){x.size * y.size, x.error * (y.size + y.error) + x.size * y.error};
}

static number product_of(number x, number y, int level) {
  return off_by(exact_product(x, y), product[level], level);
}

typedef struct {
  int precision;
  const kz_step_bounds *b;
  number w[P], s[P], c[P];
} machine;

/* Coefficient i as a sum for coefficient n takes it. */
static number rounding_taken(const machine *x, const number *of, int64_t i, int n) {
  const int own = level_of(x->precision, (int)i), level = level_of(x->precision, n);
  return own == level ? of[i] : own == level + 1 ? off_by(of[i], part[own], level) : off_by(of[i], first_part, D);
}

static void add_gain(total *of, number a, number b) {
  const number p = exact_product(a, b);
  of->sum = (number){of->sum.size + p.size, of->sum.error + p.error};
  of->products++;
}

static number rounding_scaled(total of, real by, int level) {
  return product_of(off_by(of.sum, sum_loss(level, of.products), level), of_constant(level, by), level);
}

/* The force's size along, across, and of the torque, where there is one. */
static number rounding_force(const machine *x, int64_t i, int n, real rounding_share) {
  return of_constant(level_of(x->precision, n), rounding_share * x->b->torque[i]);
}

#define ACROSS x->b->pendulum->unmirrored
#define FACTOR_along(i) rounding_force(x, i, (int)n + 1, ACROSS ? 0.4L : 1)
#define FACTOR_across(i) rounding_force(x, i, (int)n + 1, 0.4L)
#define FACTOR_w(i) rounding_taken(x, x->w, i, (int)n + 1)
#define SIZE_w velocity
#define SIZE_s sine
#define SIZE_c sine
#define UNIT_w 1
#define UNIT_s x->b->h
#define UNIT_c x->b->h
#define KZ_NEXT next_order
#define KZ_ARGUMENTS machine *x
#define KZ_SUM(of) total of = {{0, 0}, 0}
#define KZ_TERMS for (int64_t i = 0; i <= n; i++)
#define KZ_GAIN(of, f, y) add_gain(&of, FACTOR_##f(i), rounding_taken(x, x->y, n - i, (int)n + 1))
#define KZ_DAMP(of)                                     \
  add_gain(&of, rounding_taken(x, x->w, n, (int)n + 1), \
           of_constant(level_of(x->precision, (int)n + 1), x->b->h * x->b->pendulum->beta))
#define KZ_HAS_ACROSS ACROSS
#define KZ_PUSH(of) add_gain(&of, (number){1, 0}, rounding_force(x, n, (int)n + 1, 0.2L))
#define KZ_SET(name, sign, of)                                                                     \
  x->name[n + 1] = (number) {                                                                      \
    x->b->SIZE_##name[n + 1],                                                                      \
        rounding_scaled(of, UNIT_##name / ((real)n + 1), level_of(x->precision, (int)n + 1)).error \
  }
#include "taylor/motion.inc"

/* Sums of the series from the last coefficient down to `first`: of the velocity, and times h / (n + 1). */
static void sum_series(const machine *x, int first, number *d_velocity, number *d_theta) {
  *d_velocity = *d_theta = (number){0, 0};
  for (int n = x->b->order - 1; n >= first; n--) {
    const int level = level_of(x->precision, n);
    const number step = of_constant(level, x->b->h / (n + 1));
    *d_velocity = sum_of(*d_velocity, x->w[n], level);
    *d_theta = sum_of(*d_theta, level == D ? exact_product(x->w[n], step) : product_of(x->w[n], step, level), level);
  }
}

static number sum_to(number x, number y, real size, int level) {
  return off_by((number){size, x.error + y.error}, plus[level], level);
}

/* centre_doubles.c: the low parts of h v and of the angle, and what is left out of them. */
static void finish_doubles(number d_velocity, number d_theta, real fastest, real drift, real farthest, real missed[2]) {
  const real u = rounding_unit(D);
  number rest = off_by((number){2 * u * drift, 2 * u * u * drift}, 1, D);
  rest = off_by((number){rest.size + u * drift, rest.error}, 1, D);
  rest = sum_of(rest, (number){u * farthest, 0}, D);
  missed[0] = sum_of(sum_of(d_theta, rest, D), (number){u * farthest, 0}, D).error;
  missed[1] = sum_of(d_velocity, (number){u * fastest, 0}, D).error;
}

/* Largest miss of angle and velocity on the worst machine. */
static void rounding_worst(const kz_step_bounds *b, double fastest, real missed[2]) {
  machine x = {.precision = b->precision, .b = b};
  const int p = x.precision;
  const real farthest = 4 + 2 * (real)M_PI * fastest, circle = (p == TRIPLES ? 500 + 160 * (farthest + 1)
                                                                : p == PAIRS ? 48
                                                                             : 8);
  number d_velocity, d_theta;
  x.w[0] = (number){fastest, p == D ? rounding_unit(D) * fastest : 0};
  x.s[0] = x.c[0] = (number){1, circle * rounding_unit(p)};
  for (int n = 0; n + 1 < b->order; n++) next_order(&x, n);
  sum_series(&x, 1, &d_velocity, &d_theta);
  if (p == D) {
    finish_doubles(d_velocity, d_theta, fastest, b->h * fastest, farthest, missed);
    return;
  }
  const number start = {fastest, 0}, angle = {farthest, 0};
  d_theta = sum_of(d_theta, product_of(start, of_constant(p, b->h), p), p);
  missed[0] = sum_to(angle, d_theta, p == PAIRS ? farthest : farthest + d_theta.size, p).error;
  missed[1] = sum_of(d_velocity, start, p).error;
}

/* Sizes of a step: what is left out is 0. */
typedef struct {
  int precision;
  double damping, force, fastest; /* h beta, h |a|, rad per drive radian */
  int alone;                      /* coefficient of the velocity that is 1 */
} sizes;

static void set_sizes(const sizes *at, kz_pendulum *pendulum, kz_step_bounds *b) {
  *pendulum = (kz_pendulum){.beta = at->damping / 0.1};
  *b = (kz_step_bounds){
      .pendulum = pendulum, .precision = at->precision, .h = 0.1L, .order = at->precision == D ? KZ_ORDER_DOUBLES : P};
  b->torque[0] = at->force;
  if (at->alone > 0) b->velocity[at->alone] = 1;
}

/* The largest share of its bound that the worst machine reaches, in the angle and in the velocity. */
static double rounding_share_of(kz_step_bounds *b, const kz_rounding_factors *factor, double fastest) {
  real of_bound[2] = {0}, missed[2];
  b->factor = factor;
  b->fits = true;
  kz_set_errors(b, fastest);
  kz_add_rounding(b, fastest, of_bound);
  rounding_worst(b, fastest, missed);
  return (double)fmaxl(missed[0] / (of_bound[0] * KZ_MARGIN + KZ_TINY),
                       missed[1] / (of_bound[1] * KZ_MARGIN + KZ_TINY));
}

/* The factors that the lemmas need: nothing is rounded up by more than a hundredth, and no slack is left. */
static const kz_rounding_factors needed = {
    .sine = {8, 48, 500},
    .angle = {0, 0, 160},
    .start = {1, 0, 0},
    .sums = {1, 1, 1},
    .times = {2, 7.01L, 40.02L},
    .factors = {{1}, {2, 1}, {2.03L, 2.07L, 1.02L}},
    .plus = {1, 3.01L, 9},
    .state = 5,
    .slack = {0, 0, 0},
    .higher = 1 + 1e-9L,
};

#define FACTOR(name) (int)(offsetof(kz_rounding_factors, name) / sizeof(real))
enum { FACTORS = sizeof(kz_rounding_factors) / sizeof(real) };

TEST(each_factor_is_needed) {
  static const struct {
    const char *name;
    int factor;
    sizes at;
  } cases[] = {
      {"sine in doubles", FACTOR(sine[D]), {D, .force = 1}},
      {"sine in pairs", FACTOR(sine[PAIRS]), {PAIRS, .force = 1}},
      {"sine in triples", FACTOR(sine[TRIPLES]), {TRIPLES, .force = 1}},
      {"angle in triples", FACTOR(angle[TRIPLES]), {TRIPLES, .force = 1, .fastest = 10}},
      {"velocity at the start", FACTOR(start[D]), {D, .damping = 1, .fastest = 1}},
      {"sums in doubles", FACTOR(sums[D]), {D, .damping = 1, .fastest = 1}},
      {"sums in pairs", FACTOR(sums[PAIRS]), {PAIRS, .damping = 1, .fastest = 1}},
      {"sums in triples", FACTOR(sums[TRIPLES]), {TRIPLES, .damping = 1, .fastest = 1}},
      {"times in doubles", FACTOR(times[D]), {D, .damping = 1, .fastest = 1}},
      {"times in pairs", FACTOR(times[PAIRS]), {PAIRS, .damping = 1, .fastest = 1}},
      {"times in triples", FACTOR(times[TRIPLES]), {TRIPLES, .damping = 1, .fastest = 1}},
      {"factors in doubles", FACTOR(factors[D][D]), {D, .damping = 1, .fastest = 1}},
      {"factors in pairs", FACTOR(factors[PAIRS][PAIRS]), {PAIRS, .damping = 1, .fastest = 1}},
      {"factors in triples", FACTOR(factors[TRIPLES][TRIPLES]), {TRIPLES, .damping = 1, .fastest = 1}},
      {"pairs taken as doubles", FACTOR(factors[PAIRS][D]), {PAIRS, .damping = 1, .alone = KZ_COEFFICIENTS_PAIRS - 1}},
      {"triples taken as pairs",
       FACTOR(factors[TRIPLES][PAIRS]),
       {TRIPLES, .damping = 1, .alone = KZ_COEFFICIENTS_TRIPLES - 1}},
      {"pairs of triples taken as doubles",
       FACTOR(factors[TRIPLES][D]),
       {TRIPLES, .damping = 1, .alone = KZ_COEFFICIENTS_FINE - 1}},
      {"plus in doubles", FACTOR(plus[D]), {D, .alone = 1}},
      {"plus in doubles beside pairs", FACTOR(plus[D]), {PAIRS, .alone = P - 1}},
      {"plus in doubles beside triples", FACTOR(plus[D]), {TRIPLES, .alone = P - 1}},
      {"plus in pairs", FACTOR(plus[PAIRS]), {PAIRS, .alone = 1}},
      {"plus in pairs beside triples", FACTOR(plus[PAIRS]), {TRIPLES, .alone = KZ_COEFFICIENTS_TRIPLES}},
      {"times in pairs beside triples", FACTOR(times[PAIRS]), {TRIPLES, .alone = KZ_COEFFICIENTS_TRIPLES}},
      {"plus in triples", FACTOR(plus[TRIPLES]), {TRIPLES, .alone = 1}},
      {"state in doubles", FACTOR(state), {D, .fastest = 1}},
  };
  kz_step_bounds *b = malloc(sizeof *b);
  kz_pendulum pendulum;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    kz_rounding_factors cut = needed;
    ((real *)&cut)[cases[i].factor] *= 0.8L;
    set_sizes(&cases[i].at, &pendulum, b);
    const double full = rounding_share_of(b, &needed, cases[i].at.fastest),
                 less = rounding_share_of(b, &cut, cases[i].at.fastest);
    if (!(full > 0.99 && full < 1 && less > 1))
      fail_msg("%s: %.4f of the bound, %.4f of the one cut", cases[i].name, full, less);
  }
  free(b);
}

TEST(the_program_takes_at_least_what_is_needed) {
  for (int i = 0; i < FACTORS; i++) assert_true(((const real *)&kz_rounding)[i] >= ((const real *)&needed)[i]);
}

static double rounding_uniform(double from, double to) {
  return from + (to - from) * rand() / RAND_MAX;
}

/* Sizes of any kind: growing, falling, or 0, with a drive across or without. */
TEST(any_sizes_are_bounded) {
  kz_step_bounds *b = malloc(sizeof *b);
  kz_pendulum pendulum;
  double most = 0;
  srand(4);
  for (int draw = 0; draw < 600; draw++) {
    const sizes at = {.precision = draw % 3, .damping = rounding_uniform(0, 2), .force = rounding_uniform(0, 2)};
    const double fastest = draw % 5 ? rounding_uniform(0, 20) : 0, ratio = exp(rounding_uniform(-3, 0.3));
    set_sizes(&at, &pendulum, b);
    pendulum.unmirrored = draw % 2;
    for (int n = 1; n < b->order; n++) {
      b->velocity[n] = draw % 7 ? pow(ratio, n) * rounding_uniform(0, 5) : 0;
      b->sine[n] = draw % 11 ? pow(ratio, n) * rounding_uniform(0, 5) : 0;
      b->torque[n] = draw % 13 ? pow(ratio, n) * rounding_uniform(0, 1) : 0;
    }
    const double of_bound = rounding_share_of(b, &needed, fastest);
    most = fmax(most, of_bound);
    assert_true(of_bound < 1);
  }
  assert_true(most > 0.99);
  free(b);
}
