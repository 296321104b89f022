/* Taylor series of one step of the pendulum's equation (motion.inc) in any number of digits. */
#include "step.h"

int64_t kz_bits_needed(int64_t bits, int64_t size) {
  enum { FEWEST = 24, GUARD = 8 };
  const int64_t left = bits + size + GUARD;
  return left < FEWEST ? FEWEST : left > bits + GUARD ? bits + GUARD : left;
}

void kz_series_add_product(const kz_series *series, const kz_steps *steps, bool minus, const kz_number *a,
                           const kz_number *b, int64_t n, int64_t bits, kz_number *x) {
  const bool ends = a == series->along || a == series->across;
  const int64_t most = ends ? kz_smaller(n, steps->force_orders) : n;
  kz_number_dot(x, x, minus, b + (n - most), a + most, most + 1, bits);
}

void kz_series_damp(const kz_steps *steps, const kz_number *rate, int64_t n, int64_t bits, kz_number *x) {
  const int64_t most = kz_smaller(steps->damping_orders, n);
  if (most == 0)
    kz_number_multiply(x, steps->damping, rate + n, bits);
  else
    kz_number_dot(x, NULL, false, rate + (n - most), steps->damping + most, most + 1, bits);
}

#define KZ_NEXT next_order
#define KZ_ARGUMENTS kz_series *x, const kz_steps *steps, int64_t bits
#define KZ_SUM(of) KZ_NUMBER(of)
#define KZ_TERMS
#define KZ_GAIN(of, a, b) kz_series_add_product(x, steps, false, x->a, x->b, n, bits, &of)
#define KZ_DAMP(of) kz_series_damp(steps, x->w, n, bits, &of)
#define KZ_HAS_ACROSS steps->pendulum->unmirrored
#define KZ_PUSH(of) \
  if (n <= steps->force_orders) kz_number_subtract(&of, &of, x->torque + n, bits)
#define KZ_SET(name, sign, of) kz_number_divide_by(x->name + n + 1, &of, sign(n + 1), bits)
#include "taylor/motion.inc"

/* Clears the orders behind the last: an equilibrium has a short series, its neighbours a long one. */
static int64_t end_series(kz_series *series, int64_t orders) {
  for (int64_t n = orders + 1; n <= series->orders; n++) {
    kz_number_of_double(0, series->s + n);
    kz_number_of_double(0, series->c + n);
  }
  return orders;
}

int64_t kz_series_expand(kz_series *series, kz_steps *steps, int64_t i, const kz_orbit_state *state, int64_t bits) {
  const int64_t enough = -bits - 4;
  int64_t size[2] = {3, 3};
  kz_drive_expand(series, steps, i, bits + 8);
  kz_number_multiply(series->w, &state->velocity, &steps->h, bits + 8);
  kz_number_set(series->s, &state->sine);
  kz_number_set(series->c, &state->cosine);
  for (int64_t n = 0; n < series->orders; n++) {
    next_order(series, steps, kz_bits_needed(bits, kz_larger(size[0], size[1])), n);
    size[1] = size[0];
    size[0] = kz_larger(kz_number_exponent(series->w + n + 1),
                        kz_larger(kz_number_exponent(series->s + n + 1), kz_number_exponent(series->c + n + 1)));
    if (size[0] < enough && size[1] < enough) return end_series(series, n + 1);
  }
  return 0;
}

/* Sums the coefficients first .. last, smallest first. */
static void sum_coefficients(const kz_number *series, int64_t first, int64_t last, int64_t bits, kz_number *x) {
  kz_number_of_double(0, x);
  for (int64_t j = last; j >= first; j--) kz_number_add(x, x, series + j, bits);
}

/* Integrates a series over the step. */
static void integrate_series(const kz_number *series, int64_t last, int64_t bits, kz_number *x) {
  KZ_NUMBER(part);
  kz_number_of_double(0, x);
  for (int64_t j = last; j >= 0; j--) {
    kz_number_divide_by(&part, series + j, j + 1, bits);
    kz_number_add(x, x, &part, bits);
  }
}

void kz_series_sum(const kz_series *series, const kz_steps *steps, int64_t orders, int64_t tangent_orders, int64_t bits,
                   kz_orbit_state *state) {
  KZ_NUMBER(change);
  integrate_series(series->w, orders, bits + 8, &change);
  kz_number_add(&state->theta, &state->theta, &change, bits + 8);
  sum_coefficients(series->w, 1, orders, bits + 8, &change);
  kz_number_divide(&change, &change, &steps->h, bits + 8);
  kz_number_add(&state->velocity, &state->velocity, &change, bits + 8);
  sum_coefficients(series->s, 0, orders, bits + 8, &state->sine);
  sum_coefficients(series->c, 0, orders, bits + 8, &state->cosine);
  for (int axis = 0; axis < state->columns && tangent_orders > 0; axis++) {
    sum_coefficients(series->angle[axis], 0, tangent_orders, state->tangent_bits, state->angle + axis);
    sum_coefficients(series->rate[axis], 0, tangent_orders, state->tangent_bits, &change);
    kz_number_divide(state->rate + axis, &change, &steps->h, state->tangent_bits);
  }
}
