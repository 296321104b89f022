/* Taylor series of an orbit's tangent over one step (tangent.inc) in any number of digits. */
#include "step.h"

#define KZ_NEXT next_of_neighbour
#define KZ_ARGUMENTS const kz_series *series, const kz_steps *steps, int64_t bits, kz_number *x, kz_number *y
#define KZ_SUM(sum) KZ_NUMBER(sum)
#define KZ_DAMP(sum) kz_series_damp(steps, y, n, bits, &sum)
#define KZ_PUSH(sum)
#define KZ_TERMS
#define KZ_GAIN(sum) kz_number_dot(&sum, &sum, false, x, series->gain + n, n + 1, bits)
#define KZ_MOVE kz_number_divide_by(x + n + 1, y + n, n + 1, bits)
#define KZ_SET(sum) kz_number_divide_by(y + n + 1, &sum, -(n + 1), bits)
#include "taylor/tangent.inc"

static int64_t exponent_of_two(const kz_number *a, const kz_number *b) {
  return kz_larger(kz_number_exponent(a), kz_number_exponent(b));
}

int64_t kz_series_expand_tangent(kz_series *series, const kz_steps *steps, const kz_orbit_state *state) {
  const int64_t bits = state->tangent_bits;
  int64_t whole = INT32_MIN, size[2];
  for (int axis = 0; axis < state->columns; axis++) {
    kz_number_set(series->angle[axis], state->angle + axis);
    kz_number_multiply(series->rate[axis], state->rate + axis, &steps->h, bits);
    whole = kz_larger(whole, exponent_of_two(series->angle[axis], series->rate[axis]));
  }
  size[0] = size[1] = whole;
  for (int64_t n = 0; n < series->orders; n++) {
    const int64_t left = kz_bits_needed(bits, kz_larger(size[0], size[1]) - whole + 3);
    kz_number_of_double(0, series->gain + n);
    kz_series_add_product(series, steps, false, series->along, series->c, n, left, series->gain + n);
    if (steps->pendulum->unmirrored)
      kz_series_add_product(series, steps, true, series->across, series->s, n, left, series->gain + n);
    for (int axis = 0; axis < state->columns; axis++)
      next_of_neighbour(series, steps, left, series->angle[axis], series->rate[axis], n);
    size[1] = size[0];
    size[0] = INT32_MIN;
    for (int axis = 0; axis < state->columns; axis++)
      size[0] = kz_larger(size[0], exponent_of_two(series->angle[axis] + n + 1, series->rate[axis] + n + 1));
    if (kz_larger(size[0], size[1]) < whole - bits) return n + 1;
  }
  return 0;
}
