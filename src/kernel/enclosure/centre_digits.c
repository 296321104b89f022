/* A step of centres in balls of Arb: a number and a radius, which every operation widens by its own error. So a step is proved without (B2), and
 * its errors, below 1e-48, leave of (B3) the remainder of the polynomials and what three doubles do not hold of the end. */
#include <math.h>
#include <stdlib.h>

#include "digits/number.h"
#include "operations.h"

enum { P = KZ_ORDER_PAIRS, BITS = 192 };

struct kz_digit_constants {
  arb_struct damping, step, push; /* h beta, h, h torque */
  arb_ptr along, across;          /* [n_steps][P] powers of s in h a(t) and -h b(t) */
};

/* series [P] += the coefficients of h (cosine cos j t + sine sin j t) about t = 2 pi i / n: the n-th derivative turns the angle by n quarters. */
static void add_harmonic(const arb_t h, int64_t i, int64_t n_steps, int64_t j, double cosine, double sine, arb_ptr series) {
  KZ_NUMBER(c);
  KZ_NUMBER(s);
  KZ_NUMBER(even);
  KZ_NUMBER(odd);
  KZ_NUMBER(part);
  KZ_NUMBER(scale);
  fmpq_t turns;
  fmpq_init(turns);
  fmpq_set_si(turns, 2 * i * j, (ulong)n_steps);
  arb_sin_cos_pi_fmpq(&s, &c, turns, BITS);
  fmpq_clear(turns);
  arb_set_d(&part, cosine);
  arb_mul(&even, &part, &c, BITS);
  arb_mul(&odd, &part, &s, BITS);
  arb_neg(&odd, &odd);
  arb_set_d(&part, sine);
  arb_addmul(&even, &part, &s, BITS);
  arb_addmul(&odd, &part, &c, BITS);
  arb_set(&scale, h);
  for (int64_t n = 0; n < P; n++) { /* the two derivatives come in turns, and change their sign each second time */
    arb_mul(&part, &scale, n % 2 == 0 ? &even : &odd, BITS);
    if (n % 4 < 2)
      arb_add(series + n, series + n, &part, BITS);
    else
      arb_sub(series + n, series + n, &part, BITS);
    arb_mul(&scale, &scale, h, BITS);
    arb_mul_si(&scale, &scale, j, BITS);
    arb_div_si(&scale, &scale, n + 1, BITS);
  }
}

static void times_step(const arb_t step, double factor, arb_t x) {
  arb_set_d(x, factor);
  arb_mul(x, x, step, BITS);
}

kz_digit_constants *kz_digit_constants_create(const kz_pendulum *pendulum, int32_t n_steps) {
  kz_digit_constants *made = kz_calloc(1, sizeof *made);
  KZ_NUMBER(gravity);
  arb_init(&made->step);
  arb_init(&made->damping);
  arb_init(&made->push);
  made->along = _arb_vec_init(2 * (int64_t)n_steps * P);
  made->across = made->along + (int64_t)n_steps * P;
  arb_const_pi(&made->step, BITS);
  arb_mul_si(&made->step, &made->step, 2, BITS);
  arb_div_si(&made->step, &made->step, n_steps, BITS);
  times_step(&made->step, pendulum->beta, &made->damping);
  times_step(&made->step, pendulum->torque, &made->push);
  times_step(&made->step, pendulum->k, &gravity);
  for (int64_t i = 0; i < n_steps; i++) {
    const arb_ptr along = made->along + i * P, across = made->across + i * P;
    add_harmonic(&made->step, i, n_steps, 1, -pendulum->m, 0, along);
    for (int64_t j = 1; j <= pendulum->harmonics; j++) {
      const double *up = pendulum->vertical[j - 1], *right = pendulum->horizontal[j - 1];
      add_harmonic(&made->step, i, n_steps, j, -up[0], -up[1], along);
      add_harmonic(&made->step, i, n_steps, j, -right[0], -right[1], across);
    }
    arb_add(along, along, &gravity, BITS);
  }
  return made;
}

void kz_digit_constants_free(kz_digit_constants *constants, int32_t n_steps) {
  if (!constants) return;
  _arb_vec_clear(constants->along, 2 * (int64_t)n_steps * P);
  arb_clear(&constants->step);
  arb_clear(&constants->damping);
  arb_clear(&constants->push);
  free(constants);
}

/* Coefficients of the velocity, of sine and cosine, and the drive's of the step. */
typedef struct {
  const kz_digit_constants *constants;
  arb_ptr w, s, c, along, across;
} series;

#define KZ_NEXT next_order
#define KZ_ARGUMENTS series *x, bool has_across
#define KZ_SUM(of) KZ_NUMBER(of)
#define KZ_TERMS
#define KZ_GAIN(of, a, b) arb_dot(&of, &of, 0, x->a, 1, x->b + n, -1, n + 1, BITS)
#define KZ_DAMP(of) arb_mul(&of, &x->constants->damping, x->w + n, BITS)
#define KZ_HAS_ACROSS has_across
#define KZ_PUSH(of) arb_sub(&of, &of, &x->constants->push, BITS)
#define UNIT_w(of)
#define UNIT_s(of) arb_mul(&of, &of, &x->constants->step, BITS)
#define UNIT_c(of) UNIT_s(of)
#define KZ_SET(name, sign, of) \
  UNIT_##name(of);             \
  arb_div_si(x->name + n + 1, &of, sign(n + 1), BITS)
#include "taylor/motion.inc"

static void join(pair x, vector rest, int lane, arb_t sum) {
  KZ_NUMBER(part);
  arb_set_d(sum, x.high[lane]);
  arb_set_d(&part, x.low[lane]);
  arb_add(sum, sum, &part, ARF_PREC_EXACT);
  arb_set_d(&part, rest[lane]);
  arb_add(sum, sum, &part, ARF_PREC_EXACT);
}

/* The ball as a sum of three doubles; returns a bound of what they leave. */
static double part(arb_t value, int lane, pair *x, vector *rest) {
  double digits[3];
  mag_t left;
  KZ_NUMBER(digit);
  for (int i = 0; i < 3; i++) {
    digits[i] = arf_get_d(arb_midref(value), ARF_RND_NEAR);
    arb_set_d(&digit, digits[i]);
    arb_sub(value, value, &digit, ARF_PREC_EXACT);
  }
  x->high[lane] = digits[0];
  x->low[lane] = digits[1];
  (*rest)[lane] = digits[2];
  mag_init(left);
  arb_get_mag(left, value);
  const double bound = mag_get_d(left) * KZ_LARGER;
  mag_clear(left);
  return bound;
}

static void step_lane(const kz_speed_class *speed, series *y, int lane, int n_circle, kz_circle *circle, kz_sets *x) {
  KZ_NUMBER(theta);
  KZ_NUMBER(sum);
  KZ_NUMBER(term);
  join(x->theta, x->theta_rest, lane, &theta);
  join(x->velocity, x->velocity_rest, lane, y->w);
  arb_sin_cos(y->s, y->c, &theta, BITS);
  for (int n = 0; n + 1 < P; n++) next_order(y, speed->has_across, n);
  for (int n = P - 1; n >= 0; n--) {
    arb_div_si(&term, y->w + n, n + 1, BITS);
    arb_add(&sum, &sum, &term, BITS);
  }
  arb_addmul(&theta, &sum, &y->constants->step, BITS + 64);
  x->error[0][lane] = part(&theta, lane, &x->theta, &x->theta_rest);
  arb_zero(&sum);
  for (int n = P - 1; n > 0; n--) arb_add(&sum, &sum, y->w + n, BITS);
  arb_add(&sum, &sum, y->w, BITS + 64);
  x->error[1][lane] = part(&sum, lane, &x->velocity, &x->velocity_rest);
  for (int n = 0; n < n_circle; n++) circle->cosine[n][lane] = kz_number_double(y->c + n);
  for (int n = 0; n < n_circle && speed->has_across; n++) circle->sine[n][lane] = kz_number_double(y->s + n);
}

/* As for quads, lost sets do not move. */
void kz_centres_step_digits(const kz_speed_class *speed, int32_t i, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  const kz_digit_constants *constants = speed->digits;
  series y = {.constants = constants, .along = constants->along + (int64_t)i * P, .across = constants->across + (int64_t)i * P};
  y.w = _arb_vec_init(3 * P);
  y.s = y.w + P;
  y.c = y.s + P;
  for (int p = 0; p < KZ_PARTS; p++) {
    vector sine = same(0);
    sets[p].error[0] = sets[p].error[1] = same(0);
    circle[p] = (kz_circle){.cosine = {same(1)}};
    const kz_sets before = sets[p];
    for (int lane = 0; lane < LANES; lane++) {
      if (sets[p].lost[lane]) continue;
      step_lane(speed, &y, lane, n, &circle[p], &sets[p]);
      sine[lane] = kz_number_double(y.s);
    }
    sets[p].most_sine = sine_bound(speed, sine, before.velocity.high);
  }
  _arb_vec_clear(y.w, 3 * P);
}

/* (B7) */
void kz_sets_wrap_digits(kz_sets *x) {
  KZ_NUMBER(theta);
  KZ_NUMBER(turn);
  vector p[2] = {same(0), same(0)};
  for (int lane = 0; lane < LANES; lane++) {
    const double turns = rint(x->theta.high[lane] / (2 * M_PI));
    if (x->lost[lane] || turns == 0) continue;
    join(x->theta, x->theta_rest, lane, &theta);
    arb_const_pi(&turn, BITS);
    arb_submul_si(&theta, &turn, 2 * (slong)turns, BITS + 64);
    p[0][lane] = part(&theta, lane, &x->theta, &x->theta_rest);
  }
  kz_sets_widen(p, x);
}
