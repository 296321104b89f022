/* Taylor series of one step of the pendulum's equation (motion.inc), and of its tangent, in any number of digits. */
#include "step.h"

/* a h^2. */
static void times_square(double a, const kz_number *h, int64_t bits, kz_number *x) {
  kz_number_of_double(a, x);
  kz_number_multiply(x, x, h, bits);
  kz_number_multiply(x, x, h, bits);
}

static int64_t highest_harmonic(const kz_pendulum *pendulum) {
  return pendulum->harmonics > 1 ? pendulum->harmonics : 1;
}

void kz_steps_make(kz_steps *steps, int64_t orders, int64_t bits, int64_t n) {
  const kz_pendulum *pendulum = steps->pendulum;
  if (steps->n == n) return;
  KZ_NUMBER(value);
  KZ_NUMBER(size);
  steps->n = n;
  kz_number_two_pi(&steps->h, bits);
  kz_number_divide_by(&steps->h, &steps->h, n, bits);
  kz_number_of_double(pendulum->beta, &value);
  kz_number_multiply(&steps->damping, &steps->h, &value, bits);
  times_square(1, &steps->h, bits, steps->scale);
  times_square(pendulum->k, &steps->h, bits, &steps->gravity);
  times_square(pendulum->torque, &steps->h, bits, &steps->torque);
  kz_number_of_double(kz_stiffness(pendulum), &size);
  steps->force_orders = 0;
  for (int64_t j = 0; j < orders && kz_number_exponent(steps->scale + j) + kz_number_exponent(&size) > -bits; j++) {
    kz_number_multiply(steps->scale + j + 1, steps->scale + j, &steps->h, bits);
    kz_number_divide_by(steps->scale + j + 1, steps->scale + j + 1, j + 1, bits);
    kz_number_multiply_by(&size, highest_harmonic(pendulum), 64);
    steps->force_orders = j + 1;
  }
}

/* series += h^2 (cosine cos j t + sine sin j t) about a time with cos j t = c, sin j t = s: derivatives go round in a circle of four. */
static void add_harmonic(const kz_steps *steps, int64_t j, const double cosine[2], const double sine[2], const kz_number *c,
                         const kz_number *s, int64_t bits, kz_number *series) {
  KZ_NUMBER(even);
  KZ_NUMBER(odd);
  KZ_NUMBER(part);
  KZ_NUMBER(amplitude);
  kz_number *const derivative[2] = {&even, &odd};
  for (int i = 0; i < 2; i++) {
    kz_number_of_double(cosine[i], &amplitude);
    kz_number_multiply(&part, &amplitude, c, bits);
    kz_number_add(&even, &even, &part, bits);
    kz_number_multiply(&part, &amplitude, s, bits);
    kz_number_subtract(&odd, &odd, &part, bits);
    kz_number_of_double(sine[i], &amplitude);
    kz_number_multiply(&part, &amplitude, s, bits);
    kz_number_add(&even, &even, &part, bits);
    kz_number_multiply(&part, &amplitude, c, bits);
    kz_number_add(&odd, &odd, &part, bits);
  }
  kz_number_multiply_by(&odd, j, bits);
  for (int64_t n = 0; n <= steps->force_orders; n++) {
    kz_number *now = derivative[n % 2];
    kz_number_multiply(&part, steps->scale + n, now, bits);
    kz_number_add(series + n, series + n, &part, bits);
    kz_number_multiply_by(now, -j * j, bits);
  }
}

/* The drive's series from t = 2 pi i / n on. */
static void expand_force(kz_series *series, const kz_steps *steps, int64_t i, int64_t bits) {
  const kz_pendulum *p = steps->pendulum;
  KZ_NUMBER(cosine);
  KZ_NUMBER(sine);
  for (int64_t n = 0; n <= steps->force_orders; n++) {
    kz_number_of_double(0, series->along + n);
    kz_number_of_double(0, series->across + n);
  }
  for (int64_t j = 1; j <= highest_harmonic(p); j++) {
    const double *up = p->vertical[j - 1], *right = p->horizontal[j - 1];
    const double sine_of_m = j == 1 ? -p->m : 0;
    kz_number_sin_cos_of_turns(i * j, steps->n, &sine, &cosine, bits);
    add_harmonic(steps, j, (double[]){sine_of_m, -up[0]}, (double[]){0, -up[1]}, &cosine, &sine, bits, series->along);
    if (!p->unmirrored) continue;
    add_harmonic(steps, j, (double[]){-right[0], 0}, (double[]){-right[1], 0}, &cosine, &sine, bits, series->across);
  }
  kz_number_add(series->along, series->along, &steps->gravity, bits);
}

/* Bits that the next coefficient takes, where the last ones were below 2^size. */
static int64_t bits_left(int64_t bits, int64_t size) {
  enum { FEWEST = 24, GUARD = 8 };
  const int64_t left = bits + size + GUARD;
  return left < FEWEST ? FEWEST : left > bits + GUARD ? bits + GUARD : left;
}

/* Coefficient n of a product: of the drive's series only the orders that it has. */
static void add_product(const kz_series *series, const kz_steps *steps, bool minus, const kz_number *a, const kz_number *b,
                        int64_t n, int64_t bits, kz_number *x) {
  const bool ends = a == series->along || a == series->across;
  const int64_t most = ends && n > steps->force_orders ? steps->force_orders : n;
  kz_number_dot(x, x, minus, b + (n - most), a + most, most + 1, bits);
}

#define KZ_NEXT next_order
#define KZ_ARGUMENTS kz_series *x, const kz_steps *steps, int64_t bits
#define KZ_SUM(of) KZ_NUMBER(of)
#define KZ_TERMS
#define KZ_GAIN(of, a, b) add_product(x, steps, false, x->a, x->b, n, bits, &of)
#define KZ_DAMP(of) kz_number_multiply(&of, &steps->damping, x->w + n, bits)
#define KZ_HAS_ACROSS steps->pendulum->unmirrored
#define KZ_PUSH(of) kz_number_subtract(&of, &of, &steps->torque, bits)
#define KZ_SET(name, sign, of) kz_number_divide_by(x->name + n + 1, &of, sign(n + 1), bits)
#include "taylor/motion.inc"

/* A motion at rest has a short series, its neighbours a long one. */
static int64_t end_series(kz_series *series, int64_t orders) {
  for (int64_t n = orders + 1; n <= series->orders; n++) {
    kz_number_of_double(0, series->s + n);
    kz_number_of_double(0, series->c + n);
  }
  return orders;
}

int64_t kz_series_expand(kz_series *series, const kz_steps *steps, int64_t i, const kz_place *place, int64_t bits) {
  const int64_t enough = -bits - 4;
  int64_t size[2] = {3, 3};
  expand_force(series, steps, i, bits + 8);
  kz_number_multiply(series->w, &place->velocity, &steps->h, bits + 8);
  kz_number_set(series->s, &place->sine);
  kz_number_set(series->c, &place->cosine);
  for (int64_t n = 0; n < series->orders; n++) {
    next_order(series, steps, bits_left(bits, kz_larger(size[0], size[1])), n);
    size[1] = size[0];
    size[0] = kz_larger(kz_number_exponent(series->w + n + 1),
                        kz_larger(kz_number_exponent(series->s + n + 1), kz_number_exponent(series->c + n + 1)));
    if (size[0] < enough && size[1] < enough) return end_series(series, n + 1);
  }
  return 0;
}

static int64_t exponent_of_two(const kz_number *a, const kz_number *b) {
  return kz_larger(kz_number_exponent(a), kz_number_exponent(b));
}

static void expand_tangent_order(kz_series *series, const kz_steps *steps, int columns, int64_t n, int64_t bits) {
  KZ_NUMBER(damped);
  for (int axis = 0; axis < columns; axis++) {
    kz_number *x = series->angle[axis], *y = series->rate[axis];
    kz_number_set(x + n + 1, y + n);
    kz_number_divide_by(x + n + 1, x + n + 1, n + 1, bits);
    kz_number_multiply(&damped, &steps->damping, y + n, bits);
    kz_number_negate(&damped);
    kz_number_dot(y + n + 1, &damped, true, x, series->gain + n, n + 1, bits);
    kz_number_divide_by(y + n + 1, y + n + 1, n + 1, bits);
  }
}

int64_t kz_series_expand_tangent(kz_series *series, const kz_steps *steps, const kz_place *place) {
  const int64_t bits = place->tangent_bits;
  int64_t whole = INT32_MIN, size[2];
  for (int axis = 0; axis < place->columns; axis++) {
    kz_number_set(series->angle[axis], place->angle + axis);
    kz_number_multiply(series->rate[axis], place->rate + axis, &steps->h, bits);
    whole = kz_larger(whole, exponent_of_two(series->angle[axis], series->rate[axis]));
  }
  size[0] = size[1] = whole;
  for (int64_t n = 0; n < series->orders; n++) {
    const int64_t left = bits_left(bits, kz_larger(size[0], size[1]) - whole + 3);
    kz_number_of_double(0, series->gain + n);
    add_product(series, steps, false, series->along, series->c, n, left, series->gain + n);
    if (steps->pendulum->unmirrored) add_product(series, steps, true, series->across, series->s, n, left, series->gain + n);
    expand_tangent_order(series, steps, place->columns, n, left);
    size[1] = size[0];
    size[0] = INT32_MIN;
    for (int axis = 0; axis < place->columns; axis++)
      size[0] = kz_larger(size[0], exponent_of_two(series->angle[axis] + n + 1, series->rate[axis] + n + 1));
    if (kz_larger(size[0], size[1]) < whole - bits) return n + 1;
  }
  return 0;
}

/* The sum of coefficients first .. last, smallest first. */
static void sum(const kz_number *series, int64_t first, int64_t last, int64_t bits, kz_number *x) {
  kz_number_of_double(0, x);
  for (int64_t j = last; j >= first; j--) kz_number_add(x, x, series + j, bits);
}

/* The integral of a series over the step. */
static void integral(const kz_number *series, int64_t last, int64_t bits, kz_number *x) {
  KZ_NUMBER(part);
  kz_number_of_double(0, x);
  for (int64_t j = last; j >= 0; j--) {
    kz_number_divide_by(&part, series + j, j + 1, bits);
    kz_number_add(x, x, &part, bits);
  }
}

void kz_series_sum(const kz_series *series, const kz_steps *steps, int64_t orders, int64_t tangent_orders, int64_t bits,
                   kz_place *place) {
  KZ_NUMBER(change);
  integral(series->w, orders, bits + 8, &change);
  kz_number_add(&place->theta, &place->theta, &change, bits + 8);
  sum(series->w, 1, orders, bits + 8, &change);
  kz_number_divide(&change, &change, &steps->h, bits + 8);
  kz_number_add(&place->velocity, &place->velocity, &change, bits + 8);
  sum(series->s, 0, orders, bits + 8, &place->sine);
  sum(series->c, 0, orders, bits + 8, &place->cosine);
  for (int axis = 0; axis < place->columns && tangent_orders > 0; axis++) {
    sum(series->angle[axis], 0, tangent_orders, place->tangent_bits, place->angle + axis);
    sum(series->rate[axis], 0, tangent_orders, place->tangent_bits, &change);
    kz_number_divide(place->rate + axis, &change, &steps->h, place->tangent_bits);
  }
}
