/* Recurrences of a step on bounds of the sizes of its numbers. */
#include "rounding.h"

/* Factors of rounding, rounded up from the lemmas: 3.01 and 6.01 u^2 of operations on pairs, 1.01 u^3 of a constant. */
const kz_rounding_factors kz_rounding = {
    .sine = {8, 48, 500},
    .angle = {0, 0, 160},
    .start = {1, 0, 0},
    .sums = {1, 1, 1},
    .times = {2, 8, 41},
    .factors = {{2}, {2, 2}, {2.1L, 4, 3}},
    .plus = {1, 3.1L, 9},
    .state = 8,
    .slack = {1, 1, 0},
    .higher = 1.01L,
};

/* Largest ratio of a coefficient's products to itself for which parts of triples are as small as operations assume. */
static const real LARGEST_SUM = 1e10L;

static real unit_of(int level) {
  const real u = KZ_UNIT;
  return level == KZ_ENCLOSE_DOUBLES ? u : level == KZ_ENCLOSE_PAIRS ? u * u : u * u * u;
}

/* Number of coefficients that are more than doubles. */
static int fine_ones(const kz_step_bounds *b) {
  static const int number[] = {0, KZ_COEFFICIENTS_PAIRS, KZ_COEFFICIENTS_FINE};
  return number[b->precision];
}

/* Level of coefficient n. */
static int level_of(const kz_step_bounds *b, int n) {
  if (b->precision == KZ_ENCLOSE_TRIPLES && n < KZ_COEFFICIENTS_TRIPLES) return KZ_ENCLOSE_TRIPLES;
  return n < fine_ones(b) ? KZ_ENCLOSE_PAIRS : KZ_ENCLOSE_DOUBLES;
}

/* (B2) Error of a sum of n products, relative to the sizes, in units of its level. */
static real sum_loss(int level, real n) {
  if (level == KZ_ENCLOSE_TRIPLES) return 4.1L * n * n * n + 25 * n * n + 42 * n + 29;
  return level == KZ_ENCLOSE_PAIRS ? n * n + 4 * n + 9 : n;
}

static real slack_of_sums(int level, real n) {
  return level == KZ_ENCLOSE_PAIRS ? 4 * n - 1 : 2;
}

int kz_products_of(const kz_step_bounds *b, int n) {
  return n + 2 + (b->pendulum->unmirrored ? n + 2 : 0);
}

/* (B2) Relative error of a sum of products for coefficient n, times a constant. */
static real sum_error(const kz_step_bounds *b, int n, int products) {
  const kz_rounding_factors *f = b->factor;
  const int l = level_of(b, n);
  const real lost = f->sums[l] * sum_loss(l, products) + f->times[l] + f->slack[l] * slack_of_sums(l, products);
  return lost * unit_of(l) * f->higher;
}

/* (B2) Relative error of the factors of coefficient n, rounded to its level; beside triples both factors are. */
static real factor_error(const kz_step_bounds *b, int n) {
  const int l = level_of(b, n);
  return b->factor->factors[b->precision][l] * unit_of(l) * (l == KZ_ENCLOSE_DOUBLES ? 1 + KZ_UNIT : 1);
}

/* (B7) Largest angle of a centre before whole turns are removed. */
static real farthest_angle(double fastest) {
  return 4 + 2 * (real)M_PI * fastest * KZ_MARGIN;
}

void kz_set_errors(kz_step_bounds *b, double fastest) {
  const int p = b->precision;
  b->velocity[0] = fastest;
  b->sine[0] = 1;
  b->velocity_error[0] = b->factor->start[p] * unit_of(p) * fastest;
  b->sine_error[0] = (b->factor->sine[p] + b->factor->angle[p] * (farthest_angle(fastest) + 1)) * unit_of(p);
  for (int n = 0; n + 1 < b->order; n++) {
    const real damping = b->h * b->pendulum->beta * KZ_MARGIN, constant = factor_error(b, n + 1);
    const real summed = sum_error(b, n + 1, kz_products_of(b, n)) + constant;
    real v = damping * (b->velocity_error[n] + summed * (b->velocity[n] + b->velocity_error[n])), s = 0, size[2] = {0};
    for (int i = 0; i <= n; i++) {
      const real sine = b->sine[n - i] + b->sine_error[n - i], velocity = b->velocity[i] + b->velocity_error[i];
      v += b->torque[i] * (b->sine_error[n - i] + summed * sine);
      s += b->velocity_error[i] * sine + b->velocity[i] * b->sine_error[n - i] +
           (sum_error(b, n + 1, n + 1) + constant) * velocity * sine;
      size[0] += b->torque[i] * sine;
      size[1] += b->h * velocity * sine;
    }
    b->fits = b->fits && size[0] < LARGEST_SUM * b->velocity[n + 1] && size[1] < LARGEST_SUM * b->sine[n + 1];
    b->velocity_error[n + 1] = v / (n + 1) * KZ_MARGIN + KZ_TINY;
    b->sine_error[n + 1] = s * b->h / (n + 1) * KZ_MARGIN + KZ_TINY;
  }
}

/* The sum of a series from the last coefficient on, whose rounding errors are shares of the partial sums. */
typedef struct {
  real sum, partial; /* Sum of the coefficients; of all partial sums that are no triples */
  real in_doubles;   /* Sum of the doubles beside pairs */
  real in_pairs;     /* Sum of the pairs and doubles */
  real in_triples;   /* Sum of all partial sums of triples */
} series;

static void add_term(const kz_step_bounds *b, int n, real size, series *of) {
  of->sum += size;
  if (level_of(b, n) == KZ_ENCLOSE_TRIPLES) {
    of->in_triples += of->sum;
    return;
  }
  of->partial += of->in_pairs = of->sum;
  if (n == fine_ones(b) && n > 0) of->in_doubles = of->sum;
}

/* (B2) Adds the errors of the coefficients. */
static void add_errors(const kz_step_bounds *b, real error[2]) {
  for (int n = b->order - 1; n >= 1; n--) {
    error[1] += b->velocity_error[n];
    error[0] += b->velocity_error[n] * b->h / (n + 1);
  }
}

/* (B3) Adds the rounding of sums of coefficients that are doubles beside pairs; of the angle, times a constant. */
static void add_coarse(const kz_step_bounds *b, const series *v, const series *angle, real error[2]) {
  const int fine = fine_ones(b), coarse = b->order - fine;
  const real plus = b->factor->plus[KZ_ENCLOSE_DOUBLES] * KZ_UNIT * b->factor->higher,
             slack = b->factor->slack[KZ_ENCLOSE_DOUBLES];
  error[1] += (coarse + slack * (fine + 2)) * plus * v->in_doubles;
  error[0] += (coarse + 1 + slack * (fine + 3)) * plus * angle->in_doubles;
}

/* Adds the rounding in doubles of v = sum nu_n and theta = theta(0) + h sum nu_n / (n + 1), h `fastest` first. */
static void add_in_doubles(const kz_rounding_factors *f, const series *v, const series *angle, real fastest,
                           real farthest, real drift, real error[2]) {
  const real u = KZ_UNIT, plus = f->plus[KZ_ENCLOSE_DOUBLES];
  error[1] += f->higher * u * plus * (v->partial + v->sum + u * fastest);
  error[0] += f->higher * u * (plus * (angle->partial + 4 * angle->sum) + f->state * u * (drift + farthest));
}

/* Adds the rounding of these sums in pairs. */
static void add_in_pairs(const kz_rounding_factors *f, const series *v, const series *angle, real fastest,
                         real farthest, real drift, real error[2]) {
  const real u2 = KZ_UNIT * KZ_UNIT, plus = f->plus[KZ_ENCLOSE_PAIRS], times = f->times[KZ_ENCLOSE_PAIRS];
  error[1] += plus * u2 * (v->partial + fastest + v->sum);
  error[0] += plus * u2 * (angle->partial + angle->sum + drift + farthest) + times * u2 * (angle->sum + drift);
}

/* Adds the rounding of these sums in triples. */
static void add_in_triples(const kz_rounding_factors *f, const series *v, const series *angle, real fastest,
                           real farthest, real drift, real error[2]) {
  const real u2 = KZ_UNIT * KZ_UNIT, u3 = u2 * KZ_UNIT;
  const real plus = f->plus[KZ_ENCLOSE_TRIPLES], times = f->times[KZ_ENCLOSE_TRIPLES];
  const real plus_pairs = f->plus[KZ_ENCLOSE_PAIRS], times_pairs = f->times[KZ_ENCLOSE_PAIRS];
  error[1] += plus_pairs * u2 * v->partial + plus * u3 * f->higher * (v->in_triples + fastest + v->sum);
  error[0] += plus_pairs * u2 * angle->partial + times_pairs * u2 * angle->in_pairs +
              u3 * f->higher *
                  (plus * (angle->in_triples + 2 * (angle->sum + drift) + farthest) + times * (angle->sum + drift));
}

void kz_add_rounding(const kz_step_bounds *b, double fastest, real error[2]) {
  static void (*const add[])(const kz_rounding_factors *, const series *, const series *, real, real, real, real[2]) = {
      add_in_doubles, add_in_pairs, add_in_triples};
  series v = {0}, angle = {0};
  add_errors(b, error);
  for (int n = b->order - 1; n >= 1; n--) {
    const real size = b->velocity[n] + b->velocity_error[n];
    add_term(b, n, size, &v);
    add_term(b, n, size * b->h / (n + 1), &angle);
  }
  add_coarse(b, &v, &angle, error);
  add[b->precision](b->factor, &v, &angle, fastest, farthest_angle(fastest), b->h * fastest, error);
}
