/* Taylor series of one step of theta'' + beta theta' + (k - m cos t) sin theta = 0, and of its tangent.
 *
 * With b = h v, s = sin theta, c = cos theta, f = h^2 (k - m cos t), as series in (t - t0) / h:
 *   (n + 1) s_(n+1) = sum c_j b_(n-j),   (n + 1) c_(n+1) = -sum s_j b_(n-j),   (n + 1) b_(n+1) = -beta h b_n - sum f_j s_(n-j).
 * A neighbour at the distance (x, y / h): (n + 1) x_(n+1) = y_n, (n + 1) y_(n+1) = -beta h y_n - sum (f c)_j x_(n-j). */
#include "step.h"

void kz_steps_make(kz_steps *steps, const kz_pendulum *pendulum, int64_t orders, int64_t bits, int64_t n) {
  if (steps->n == n) return;
  KZ_NUMBER(value);
  steps->n = n;
  kz_number_two_pi(&steps->h, bits);
  kz_number_divide_by(&steps->h, &steps->h, n, bits);
  kz_number_of_double(pendulum->beta, &value);
  kz_number_multiply(&steps->damping, &steps->h, &value, bits);
  kz_number_of_double(pendulum->m, &value);
  kz_number_multiply(&value, &value, &steps->h, bits);
  kz_number_multiply(steps->scale, &value, &steps->h, bits);
  kz_number_of_double(pendulum->k, &value);
  kz_number_multiply(&value, &value, &steps->h, bits);
  kz_number_multiply(&steps->gravity, &value, &steps->h, bits);
  steps->force_orders = 0;
  for (int64_t j = 0; j < orders && kz_number_exponent(steps->scale + j) > -bits; j++) {
    kz_number_multiply(steps->scale + j + 1, steps->scale + j, &steps->h, bits);
    kz_number_divide_by(steps->scale + j + 1, steps->scale + j + 1, j + 1, bits);
    steps->force_orders = j + 1;
  }
}

/* The drive's series from t = 2 pi i / n on: derivatives of the cosine follow each other in a circle of four. */
static void expand_force(kz_series *series, const kz_steps *steps, int64_t i, int64_t bits) {
  KZ_NUMBER(cosine);
  KZ_NUMBER(sine);
  KZ_NUMBER(minus_cosine);
  KZ_NUMBER(minus_sine);
  const kz_number *const circle[4] = {&minus_cosine, &sine, &cosine, &minus_sine};
  kz_number_sin_cos_of_turns(i, steps->n, &sine, &cosine, bits);
  kz_number_set(&minus_sine, &sine);
  kz_number_negate(&minus_sine);
  kz_number_set(&minus_cosine, &cosine);
  kz_number_negate(&minus_cosine);
  for (int64_t j = 0; j <= steps->force_orders; j++)
    kz_number_multiply(series->force + j, steps->scale + j, circle[j % 4], bits);
  kz_number_add(series->force, series->force, &steps->gravity, bits);
}

/* Bits that the next coefficient takes, where the last ones were below 2^size. */
static int64_t bits_left(int64_t bits, int64_t size) {
  enum { FEWEST = 24, GUARD = 8 };
  const int64_t left = bits + size + GUARD;
  return left < FEWEST ? FEWEST : left > bits + GUARD ? bits + GUARD : left;
}

static void expand_order(kz_series *series, const kz_steps *steps, int64_t n, int64_t bits) {
  kz_number *b = series->speed, *s = series->sine, *c = series->cosine;
  const int64_t first = kz_larger(0, n - steps->force_orders);
  KZ_NUMBER(damped);
  kz_number_dot(s + n + 1, NULL, false, c, b + n, n + 1, bits);
  kz_number_divide_by(s + n + 1, s + n + 1, n + 1, bits);
  kz_number_dot(c + n + 1, NULL, true, s, b + n, n + 1, bits);
  kz_number_divide_by(c + n + 1, c + n + 1, n + 1, bits);
  kz_number_multiply(&damped, &steps->damping, b + n, bits);
  kz_number_negate(&damped);
  kz_number_dot(b + n + 1, &damped, true, s + first, series->force + (n - first), n - first + 1, bits);
  kz_number_divide_by(b + n + 1, b + n + 1, n + 1, bits);
}

/* A motion at rest has a short series, its neighbours a long one. */
static int64_t end_series(kz_series *series, int64_t orders) {
  for (int64_t n = orders + 1; n <= series->orders; n++) {
    kz_number_of_double(0, series->sine + n);
    kz_number_of_double(0, series->cosine + n);
  }
  return orders;
}

int64_t kz_series_expand(kz_series *series, const kz_steps *steps, int64_t i, const kz_place *place, int64_t bits) {
  const int64_t enough = -bits - 4;
  int64_t size[2] = {3, 3};
  expand_force(series, steps, i, bits + 8);
  kz_number_multiply(series->speed, &place->velocity, &steps->h, bits + 8);
  kz_number_set(series->sine, &place->sine);
  kz_number_set(series->cosine, &place->cosine);
  for (int64_t n = 0; n < series->orders; n++) {
    expand_order(series, steps, n, bits_left(bits, kz_larger(size[0], size[1])));
    size[1] = size[0];
    size[0] = kz_larger(kz_number_exponent(series->speed + n + 1),
                        kz_larger(kz_number_exponent(series->sine + n + 1), kz_number_exponent(series->cosine + n + 1)));
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
    const int64_t first = kz_larger(0, n - steps->force_orders);
    const int64_t left = bits_left(bits, kz_larger(size[0], size[1]) - whole + 3);
    kz_number_dot(series->gain + n, NULL, false, series->cosine + first, series->force + (n - first), n - first + 1, left);
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
  integral(series->speed, orders, bits + 8, &change);
  kz_number_add(&place->theta, &place->theta, &change, bits + 8);
  sum(series->speed, 1, orders, bits + 8, &change);
  kz_number_divide(&change, &change, &steps->h, bits + 8);
  kz_number_add(&place->velocity, &place->velocity, &change, bits + 8);
  sum(series->sine, 0, orders, bits + 8, &place->sine);
  sum(series->cosine, 0, orders, bits + 8, &place->cosine);
  for (int axis = 0; axis < place->columns && tangent_orders > 0; axis++) {
    sum(series->angle[axis], 0, tangent_orders, place->tangent_bits, place->angle + axis);
    sum(series->rate[axis], 0, tangent_orders, place->tangent_bits, &change);
    kz_number_divide(place->rate + axis, &change, &steps->h, place->tangent_bits);
  }
}
