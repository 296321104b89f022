/* Constants of the steps of a class of speeds, rounded from balls of Arb that hold them. */
#include "digits/number.h"
#include "sets.h"

enum { BITS = 192 };

/* Off by at most u of the number as a double, u^2 as a sum of two, 1.01 u^3 as one of three. */
static kz_constant rounded(const kz_number *x) {
  double part[3];
  KZ_NUMBER(rest);
  KZ_NUMBER(first);
  kz_number_set(&rest, x);
  for (int i = 0; i < 3; i++) {
    part[i] = kz_number_double(&rest);
    kz_number_of_double(part[i], &first);
    kz_number_subtract(&rest, &rest, &first, BITS);
  }
  return (kz_constant){part[0], part[1], part[2]};
}

/* series [order] += the coefficients of h (cosine cos j t + sine sin j t) about t = 2 pi i / n_steps: the n-th derivative turns the angle by n
 * quarters. */
static void add_harmonic(const arb_t h, int64_t i, int64_t n_steps, int64_t j, const double amplitude[2], int64_t order,
                         arb_ptr series) {
  KZ_NUMBER(c);
  KZ_NUMBER(s);
  KZ_NUMBER(part);
  KZ_NUMBER(scale);
  kz_number derivative[2];
  if (!(fabs(amplitude[0]) + fabs(amplitude[1]) > 0)) return;
  for (int k = 0; k < 2; k++) arb_init(derivative + k);
  kz_number_sin_cos_of_turns(i * j, n_steps, &s, &c, BITS);
  for (int k = 0; k < 2; k++) { /* of cosine and sine: (c, s), (-s, c) */
    arb_set_d(&part, amplitude[k]);
    arb_addmul(derivative, &part, k == 0 ? &c : &s, BITS);
    if (k == 0)
      arb_submul(derivative + 1, &part, &s, BITS);
    else
      arb_addmul(derivative + 1, &part, &c, BITS);
  }
  arb_set(&scale, h);
  for (int64_t n = 0; n < order; n++) { /* the two derivatives come in turns, and change their sign each second time */
    if (n % 4 < 2)
      arb_addmul(series + n, &scale, derivative + n % 2, BITS);
    else
      arb_submul(series + n, &scale, derivative + n % 2, BITS);
    arb_mul(&scale, &scale, h, BITS);
    arb_mul_si(&scale, &scale, j, BITS);
    arb_div_si(&scale, &scale, n + 1, BITS);
  }
  for (int k = 0; k < 2; k++) arb_clear(derivative + k);
}

static kz_constant times(const arb_t step, double factor) {
  KZ_NUMBER(x);
  arb_set_d(&x, factor);
  arb_mul(&x, &x, step, BITS);
  return rounded(&x);
}

/* The powers of s = 0 .. 1 in h a(t + h s) and -h b(t + h s) of step i. */
static void expand_force(const kz_pendulum *p, const arb_t h, int64_t i, kz_speed_class *speed) {
  const int64_t order = speed->order, n_steps = speed->n_steps;
  const arb_ptr along = _arb_vec_init(2 * order), across = along + order;
  KZ_NUMBER(gravity);
  arb_set_d(&gravity, p->k);
  arb_mul(along, &gravity, h, BITS);
  add_harmonic(h, i, n_steps, 1, (double[]){-p->m, 0}, order, along);
  for (int64_t j = 1; j <= p->harmonics; j++) {
    const double *up = p->vertical[j - 1], *right = p->horizontal[j - 1];
    add_harmonic(h, i, n_steps, j, (double[]){-up[0], -up[1]}, order, along);
    add_harmonic(h, i, n_steps, j, (double[]){-right[0], -right[1]}, order, across);
  }
  for (int64_t n = 0; n < order; n++) {
    speed->along[i * order + n] = rounded(along + n);
    speed->across[i * order + n] = rounded(across + n);
  }
  _arb_vec_clear(along, 2 * order);
}

void kz_speed_class_set_constants(const kz_pendulum *pendulum, kz_speed_class *speed) {
  KZ_NUMBER(h);
  KZ_NUMBER(x);
  arb_const_pi(&h, BITS);
  arb_mul_2exp_si(&h, &h, 1);
  arb_div_si(&h, &h, speed->n_steps, BITS);
  speed->damping = times(&h, pendulum->beta);
  speed->push = times(&h, pendulum->torque);
  for (int32_t n = 0; n < speed->order; n++) {
    arb_div_si(&x, &h, n + 1, BITS);
    speed->step[n] = rounded(&x);
    arb_set_si(&x, 1);
    arb_div_si(&x, &x, n + 1, BITS);
    speed->inverse[n] = rounded(&x);
  }
  for (int64_t i = 0; i < speed->n_steps; i++) expand_force(pendulum, &h, i, speed);
}
