/* Constants of the steps of a class of speeds, rounded from numbers of 192 bits. */
#include "digits/step.h"
#include "sets.h"

enum { BITS = 192 };

/* Rounds to three doubles, with a relative error of at most u as one double, u^2 as two, 1.01 u^3 as three. */
static kz_constant round_constant(const kz_number *x) {
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

static kz_constant scaled_constant(const arb_t step, double factor) {
  KZ_NUMBER(x);
  arb_set_d(&x, factor);
  arb_mul(&x, &x, step, BITS);
  return round_constant(&x);
}

/* Sets the powers of s = 0 .. 1 in h a(t + h s), -h b(t + h s) and h torque(t + h s) of all steps. */
static void set_force(const kz_pendulum *pendulum, const arb_t h, kz_speed_class *speed) {
  const int64_t order = speed->order;
  const kz_stretch whole = {.is_whole = true};
  kz_number *const numbers = kz_numbers_make(4 * order);
  kz_series series = {.along = numbers + order, .across = numbers + 2 * order, .torque = numbers + 3 * order};
  kz_steps steps = {
      .pendulum = pendulum, .stretch = &whole, .n = speed->n_steps, .scale = numbers, .force_orders = order - 1};
  KZ_NUMBER(x);
  kz_number_of_double(pendulum->k, &x);
  kz_number_multiply(&steps.gravity, &x, h, BITS);
  kz_number_of_double(pendulum->torque, &x);
  kz_number_multiply(&steps.torque, &x, h, BITS);
  kz_number_set(numbers, h);
  for (int64_t n = 1; n < order; n++) {
    kz_number_multiply(numbers + n, numbers + n - 1, h, BITS);
    kz_number_divide_by(numbers + n, numbers + n, n, BITS);
  }
  for (int64_t i = 0; i < speed->n_steps; i++) {
    kz_drive_expand(&series, &steps, i, BITS);
    for (int64_t n = 0; n < order; n++) {
      speed->along[i * order + n] = round_constant(series.along + n);
      speed->across[i * order + n] = round_constant(series.across + n);
      speed->torque[i * order + n] = round_constant(series.torque + n);
    }
  }
  kz_number_clear(&steps.gravity);
  kz_number_clear(&steps.torque);
  kz_numbers_free(numbers, 4 * order);
}

void kz_speed_class_set_constants(const kz_pendulum *pendulum, kz_speed_class *speed) {
  KZ_NUMBER(h);
  KZ_NUMBER(x);
  arb_const_pi(&h, BITS);
  arb_mul_2exp_si(&h, &h, 1);
  arb_div_si(&h, &h, speed->n_steps, BITS);
  speed->damping = scaled_constant(&h, pendulum->beta);
  for (int32_t n = 0; n < speed->order; n++) {
    arb_div_si(&x, &h, n + 1, BITS);
    speed->step[n] = round_constant(&x);
    arb_set_si(&x, 1);
    arb_div_si(&x, &x, n + 1, BITS);
    speed->inverse[n] = round_constant(&x);
  }
  set_force(pendulum, &h, speed);
}
