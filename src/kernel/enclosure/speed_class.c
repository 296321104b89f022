/* The step of a class of speeds, and the bounds (B2) .. (B6) of docs/explanation/bounds.md: Taylor's rest by the majorants, rounding by the recurrences
 * of the step on bounds of the numbers' sizes. */
#include <math.h>
#include <stdlib.h>

#include "majorants.h"
#include "sets.h"

enum { MOST_STEPS = 4096, P = KZ_ORDER_PAIRS, MOST = KZ_ORDER_JACOBIAN, MOTION = -1 };
static const real CAUTION = 1 + 1e-9L; /* relative, far above the rounding of the bounds and in the C library's functions */
static const real U = 0x1p-53L;
/* Of the sizes of the products in a coefficient, over its own: then |x_1| and |x_2| of a triple are as small as its operations take them. */
static const real LARGEST_SUM = 1e10L;
static const real TINY = 1e-280L; /* products below the range of doubles */

/* The bounds of a step. */
typedef struct {
  const kz_pendulum *pendulum;
  int n_majorants, order;
  bool pairs, triples; /* triples: with the first coefficients in triples, else as pairs */
  bool fits;           /* whether the sizes of products are what (B2) counts on */
  real h;
  real torque[P];                        /* sizes of the torque's powers of s */
  real velocity[P], sine[P];             /* sizes of coefficients; of the cosine's too */
  real velocity_error[P], sine_error[P]; /* of the computed ones */
  majorant majorant[MAJORANTS];
} bounds;

/* Is coefficient n a triple? */
static bool is_triple(const bounds *b, int n) {
  return b->triples && n < KZ_COEFFICIENTS_TRIPLES;
}

/* Number of coefficients that are more than doubles. */
static int fine_ones(const bounds *b) {
  return b->triples ? KZ_COEFFICIENTS_FINE : b->pairs ? KZ_COEFFICIENTS_PAIRS : 0;
}

/* Is it a pair? */
static bool is_pair(const bounds *b, int n) {
  return n < fine_ones(b);
}

/* Factors of u^2, (B3) of docs/explanation/bounds.md: of a sum of two pairs (3.01, `plus` of operations.h); of a product of a pair and a rounded
 * constant (6.01, `times`, and 1 for the constant). And the factor for what is of higher order, (1 + u)^n with n u below 1e-2. */
static const real PLUS = 3.1L, TIMES = 8, HIGHER = 1.01L;

/* Factors of u^3: of a sum of two triples; of a product of a triple and a rounded constant. And (B2) of a sum of n products of triples. */
static const real PLUS_TRIPLES = 9, TIMES_TRIPLES = 41;
static real sum_of_triples(real n) {
  return 4.1L * n * n * n + 25 * n * n + 42 * n + 29;
}

/* Relative: of a sum of products for coefficient n, one factor of which is a constant or computed, times a constant. */
static real sum_error(const bounds *b, int n, int products) {
  if (is_triple(b, n)) return (sum_of_triples(products) + TIMES_TRIPLES) * U * U * U * HIGHER;
  return is_pair(b, n) ? (real)(products + 4) * (products + 4) * U * U * HIGHER : (products + 4) * U * HIGHER;
}

static void set_sizes(bounds *b) {
  kz_force_sizes(b->pendulum, b->h, b->order, b->torque);
  for (int n = 0; n < b->order; n++) {
    b->torque[n] *= CAUTION;
    b->velocity[n] = b->sine[n] = HUGE_VALL;
  }
  for (int i = 0; i < b->n_majorants; i++) {
    const majorant *at = &b->majorant[i];
    const real ratio = b->h / at->r * CAUTION;
    real power = CAUTION;
    for (int n = 0; n < b->order; n++, power *= ratio) {
      b->velocity[n] = fminl(b->velocity[n], at->w * power);
      b->sine[n] = fminl(b->sine[n], coshl(at->y) * power);
    }
  }
}

/* Relative: of the factors of coefficient n that were rounded, to triples, to pairs or, where high parts are multiplied, to doubles. The
 * damping's, 1 / n and h / n: in sum_error. Beside triples, both factors of a product are. */
static real factor_error(const bounds *b, int n) {
  if (is_triple(b, n)) return 3 * U * U * U;
  if (is_pair(b, n)) return (b->triples ? 4 : 2) * U * U;
  return (b->triples ? 2.1L : 2) * U * (1 + U);
}

/* Number of products in the force of coefficient n + 1: the damping's, and those along; those across and the torque. */
static int products_of(const bounds *b, int n) {
  return n + 2 + (b->pendulum->unmirrored ? n + 2 : 0);
}

/* (B7) An angle of a centre before whole turns are taken out. */
static real farthest_angle(double fastest) {
  return 4 + 2 * (real)M_PI * fastest * CAUTION;
}

/* (B2) The recurrences of the step, on errors. */
static void set_errors(bounds *b, double fastest) {
  b->velocity[0] = fastest;
  b->sine[0] = 1;
  b->velocity_error[0] = b->pairs ? 0 : U * fastest;
  b->sine_error[0] = b->triples ? (500 + 160 * (farthest_angle(fastest) + 1)) * U * U * U : b->pairs ? 48 * U * U : 8 * U;
  for (int n = 0; n + 1 < b->order; n++) {
    const real damping = b->h * b->pendulum->beta * CAUTION, constant = factor_error(b, n + 1);
    const real summed = sum_error(b, n + 1, products_of(b, n)) + constant;
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
    b->velocity_error[n + 1] = v / (n + 1) * CAUTION + TINY;
    b->sine_error[n + 1] = s * b->h / (n + 1) * CAUTION + TINY;
  }
}

/* What a step misses of the angle and of the velocity. */
typedef struct {
  real theta, velocity;
} missed;

/* The sum of a series from the last coefficient on. Each partial sum is rounded, so that errors are shares of the partial sums. */
typedef struct {
  real sum, partial; /* of the coefficients; of all partial sums of those that are no triples */
  real in_doubles;   /* of those that are doubles beside pairs */
  real in_pairs;     /* of those that are no triples */
  real in_triples;   /* of all partial sums of triples */
} series;

static void add_term(const bounds *b, int n, real size, series *of) {
  of->sum += size;
  if (is_triple(b, n)) {
    of->in_triples += of->sum;
    return;
  }
  of->partial += of->in_pairs = of->sum;
  if (n == fine_ones(b)) of->in_doubles = of->sum;
}

/* (B2) The errors of the coefficients. */
static void add_errors(const bounds *b, missed *step) {
  for (int n = b->order - 1; n >= 1; n--) {
    step->velocity += b->velocity_error[n];
    step->theta += b->velocity_error[n] * b->h / (n + 1);
  }
}

/* (B3) The rounding of the sums v = sum nu_n and theta = theta(0) + h sum nu_n / (n + 1), whose first term is h `fastest`. */
static void add_rounding(const bounds *b, double fastest, missed *step) {
  const real h = b->h, farthest = farthest_angle(fastest);
  series v = {0}, angle = {0};
  for (int n = b->order - 1; n >= 1; n--) {
    const real size = b->velocity[n] + b->velocity_error[n];
    add_term(b, n, size, &v);
    add_term(b, n, size * h / (n + 1), &angle);
  }
  if (b->pairs) {
    step->velocity += (b->order + 2) * U * HIGHER * v.in_doubles;
    step->theta += (b->order + 4) * U * HIGHER * angle.in_doubles;
  }
  if (b->triples) {
    step->velocity += PLUS * U * U * v.partial + PLUS_TRIPLES * U * U * U * HIGHER * (v.in_triples + fastest + v.sum);
    step->theta += PLUS * U * U * angle.partial + TIMES * U * U * angle.in_pairs +
                   U * U * U * HIGHER *
                       (PLUS_TRIPLES * (angle.in_triples + 2 * (angle.sum + h * fastest) + farthest) +
                        TIMES_TRIPLES * (angle.sum + h * fastest));
  } else if (b->pairs) {
    step->velocity += PLUS * U * U * (v.partial + fastest + v.sum);
    step->theta +=
        PLUS * U * U * (angle.partial + angle.sum + h * fastest + farthest) + TIMES * U * U * (angle.sum + h * fastest);
  } else {
    step->velocity += HIGHER * U * (v.partial + v.sum + U * fastest);
    step->theta += HIGHER * U * (angle.partial + 4 * angle.sum + TIMES * U * (h * fastest + farthest));
  }
}

/* (B0) What the terms below `order` leave: of the motion's velocity, or of that of a column of the tangent map. */
static real rest_of(const bounds *b, int order, int column) {
  real rest = HUGE_VALL;
  for (int i = 0; i < b->n_majorants; i++) {
    const majorant *at = &b->majorant[i];
    const real ratio = b->h / at->r * CAUTION;
    if (ratio < 0.99L) rest = fminl(rest, (column == MOTION ? at->w : at->slope[column]) * powl(ratio, order) / (1 - ratio));
  }
  return rest;
}

/* (B3) A step of the centre: errors of its coefficients, rounding of their sums, and what the polynomials leave. */
static void bound_centre(const bounds *b, double fastest, kz_speed_class *speed) {
  missed step = {0};
  add_errors(b, &step);
  add_rounding(b, fastest, &step);
  const real rest = rest_of(b, b->order, MOTION);
  speed->velocity_error = (double)((step.velocity + rest) * CAUTION + TINY);
  speed->theta_error = (double)((step.theta + rest * b->h / (b->order + 1)) * CAUTION + TINY);
}

/* Rounding in a column that begins with a = 1 or b = 1, computed in doubles: of its angle and velocity at the step's end. */
static void column_rounding(const bounds *b, int T, const real stiffness[MOST], const real stiffness_error[MOST], int c,
                            real error[2]) {
  real a[MOST + 1] = {c == 0}, v[MOST + 1] = {c == 1}, a_error[MOST + 1] = {0}, v_error[MOST + 1] = {0};
  const real h = b->h * CAUTION, damping = h * b->pendulum->beta;
  error[0] = 4 * U * h * v[0];
  error[1] = 0;
  for (int n = 0; n < T; n++) {
    const real summed = (n + 6) * U * HIGHER;
    real size = damping * v[n], off = damping * (v_error[n] + summed * (v[n] + v_error[n]));
    for (int j = 0; j <= n; j++) {
      const real angle = a[n - j] + a_error[n - j];
      size += stiffness[j] * a[n - j];
      off += stiffness[j] * a_error[n - j] + stiffness_error[j] * angle + summed * (stiffness[j] + stiffness_error[j]) * angle;
    }
    a[n + 1] = v[n] * h / (n + 1);
    a_error[n + 1] = (v_error[n] + 4 * U * (v[n] + v_error[n])) * h / (n + 1) + TINY;
    v[n + 1] = size / (n + 1);
    v_error[n + 1] = off / (n + 1) + TINY;
    error[0] += a_error[n + 1];
    if (n + 1 < T) error[1] += v_error[n + 1];
  }
  for (int n = 0; n <= T; n++) { /* T + 2 sums of at most these */
    error[0] += (T + 2) * U * HIGHER * (a[n] + a_error[n]);
    if (n < T) error[1] += (T + 2) * U * HIGHER * (v[n] + v_error[n]);
  }
}

/* (B4) Of the tangent map in doubles, to order T: rounding, and the rest of its polynomials. */
static void bound_tangent(const bounds *b, int T, double tangent_error[2][2]) {
  real stiffness[MOST], stiffness_error[MOST];
  for (int n = 0; n < T; n++) {
    stiffness[n] = stiffness_error[n] = 0;
    for (int j = 0; j <= n; j++) {
      const real cosine = b->sine[n - j], off = b->sine_error[n - j] + U * (cosine + b->sine_error[n - j]);
      stiffness[n] += b->torque[j] * cosine;
      stiffness_error[n] += b->torque[j] * (off + (products_of(b, n) + 2) * U * HIGHER * (cosine + off));
    }
  }
  for (int c = 0; c < 2; c++) {
    real rounding[2];
    column_rounding(b, T, stiffness, stiffness_error, c, rounding);
    const real rest = rest_of(b, T, c);
    tangent_error[0][c] = (double)((rounding[0] + rest * b->h / (T + 1)) * CAUTION);
    tangent_error[1][c] = (double)((rounding[1] + rest) * CAUTION);
  }
}

/* (B5), (B6) Neighbours against y'' = beta y' + Q y, Q >= |a(t)|, whose solutions grow as exp(rate t) at most. */
static void bound_neighbours(const bounds *b, kz_speed_class *speed) {
  const real stiffness = kz_stiffness(b->pendulum) * CAUTION, beta = b->pendulum->beta, h = b->h;
  const real rate = (beta + sqrtl(beta * beta + 4 * stiffness)) / 2, growth = expl(rate * h) * CAUTION;
  speed->farthest[0] = (double)((1 + stiffness * h * h / 2 * growth) * CAUTION);
  speed->farthest[1] = (double)(h * growth * CAUTION);
  speed->nonlinear[0] = (double)(h * h / 2 * growth * CAUTION);
  speed->nonlinear[1] = (double)(h * growth * CAUTION);
  speed->turn = (double)(stiffness * h * h / 2 * CAUTION);
  for (int j = 0; j < b->pendulum->harmonics; j++)
    speed->most_across += hypot(b->pendulum->horizontal[j][0], b->pendulum->horizontal[j][1]) * (double)CAUTION;
  for (int32_t i = 0; i < speed->n_steps; i++)
    speed->most_torque[i] = (double)(kz_force_largest(b->pendulum, i, h) + stiffness * 1e-6L);
}

/* The number of steps for which the last coefficient is small beside rounding, 0 where that takes too many. */
static int32_t choose_steps(const bounds *b) {
  const real target = b->triples ? 1e-46L : b->pairs ? 1e-31L : 1e-16L;
  real longest = 0;
  for (int i = 0; i < b->n_majorants; i++)
    longest = fmaxl(longest, b->majorant[i].r * powl(target / b->majorant[i].w, 1.0L / b->order));
  return longest * MOST_STEPS > 2 * M_PI ? (int32_t)(2 * M_PI / (double)longest) + 1 : 0;
}

/* A frame is renewed before damping has made the columns of its matrix alike. */
static int32_t steps_of_frame(const kz_pendulum *pendulum, int32_t n_steps) {
  const double frames = fmin(ceil(2 * M_PI * pendulum->beta), n_steps);
  return frames > 1 ? (int32_t)(n_steps / frames) : n_steps;
}

static kz_speed_class *create(bounds *b, double fastest, int32_t wanted) {
  b->n_majorants = kz_majorants_find(b->pendulum, fastest, b->majorant);
  const int32_t n_steps = wanted > 0 ? wanted : choose_steps(b);
  if (n_steps == 0) return NULL;
  kz_speed_class *made = kz_calloc(
      1, sizeof *made + 2 * (size_t)(n_steps * b->order) * sizeof *made->along + (size_t)n_steps * sizeof *made->most_torque);
  made->across = made->along + n_steps * b->order;
  made->most_torque = (double *)(made->across + n_steps * b->order);
  made->has_across = b->pendulum->unmirrored;
  made->n_steps = n_steps;
  made->order = b->order;
  made->fastest = fastest;
  made->frame_steps = steps_of_frame(b->pendulum, n_steps);
  kz_speed_class_set_constants(b->pendulum, made);
  b->h = 2 * (real)M_PI / n_steps * CAUTION;
  set_sizes(b);
  set_errors(b, fastest);
  if (b->triples && !b->fits) {
    free(made);
    return NULL;
  }
  bound_centre(b, fastest, made);
  bound_tangent(b, KZ_ORDER_TANGENT, made->tangent_error[false]);
  bound_tangent(b, KZ_ORDER_JACOBIAN, made->tangent_error[true]);
  bound_neighbours(b, made);
  return made;
}

kz_speed_class *kz_speed_class_create(const kz_pendulum *pendulum, int32_t precision, double fastest, int32_t n_steps) {
  bounds *b = kz_calloc(1, sizeof *b);
  b->pendulum = pendulum;
  b->triples = precision == KZ_ENCLOSE_TRIPLES;
  b->pairs = b->triples || precision == KZ_ENCLOSE_PAIRS;
  b->fits = true;
  b->order = b->pairs ? KZ_ORDER_PAIRS : KZ_ORDER_DOUBLES;
  kz_speed_class *speed = create(b, fastest, n_steps);
  free(b);
  return speed;
}
