/* Measures of a motion itself and of the linear motion near it: mean velocity; return time by Floquet's multipliers,
 * growth of small disturbances by singular values of the map's derivatives, in the norm hypot(dtheta, dvelocity /
 * shock_scale). */
#include "measures.h"

/* The largest singular value of a matrix of 2 x 2 in that norm. */
static double linear_growth(const double matrix[4], double scale) {
  const double a = matrix[0], b = matrix[1] * scale, c = matrix[2] / scale, d = matrix[3];
  return (hypot(a + d, b - c) + hypot(a - d, b + c)) / 2;
}

/* product = left * right. */
static void linear_multiply(const double left[4], const double right[4], double product[4]) {
  const double of[4] = {left[0] * right[0] + left[1] * right[2], left[0] * right[1] + left[1] * right[3],
                        left[2] * right[0] + left[3] * right[2], left[2] * right[1] + left[3] * right[3]};
  memcpy(product, of, sizeof of);
}

/* Drive periods in which the slowest disturbance falls to 1/e. */
void kz_measure_return_time(const kz_measured *measured, double *value) {
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    const kz_attractor *row = &measured->catalogue.entries[id].row;
    const double largest = hypot(row->multiplier_re[0], row->multiplier_im[0]);
    value[id] = row->period > 0 ? -row->period / log(largest) : NAN;
  }
}

/* Measure of a cycle from its turns, to the last digit. */
void kz_measure_mean_velocity(const kz_measured *measured, double *value) {
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    const kz_attractor *row = &measured->catalogue.entries[id].row;
    value[id] = row->period > 0 ? (double)row->winding / row->period : row->mean_velocity;
  }
}

/* Growth from the strobe point `phase` of a cycle with these derivatives. */
typedef double (*growth_fn)(const kz_tangent *tangent, int32_t period, int32_t phase, double scale);

/* In one drive period. */
static double next_growth(const kz_tangent *tangent, int32_t period, int32_t phase, double scale) {
  (void)period;
  return linear_growth(tangent[phase].matrix, scale);
}

/* The largest at any later strobe, at least 1. After whole turns of the orbit that leave no
 * disturbance larger than it was, none becomes larger than before. */
static double later_growth(const kz_tangent *tangent, int32_t period, int32_t phase, double scale) {
  enum { MOST = 1000000 };
  double product[4] = {1, 0, 0, 1}, largest = 1;
  for (int step = 0; step < MOST; step++) {
    linear_multiply(tangent[(phase + step) % period].matrix, product, product);
    const double now = linear_growth(product, scale);
    largest = fmax(largest, now);
    if ((step + 1) % period == 0 && now <= 1) return largest;
  }
  return NAN; /* it decays too slowly to be known */
}

/* The largest over the strobe points; NaN for chaotic attractors. */
static void largest_growth(const kz_measured *measured, growth_fn of, double *value) {
  const kz_tangent *tangent = measured->tangent;
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    const int32_t period = measured->catalogue.entries[id].row.period;
    value[id] = NAN;
    for (int32_t phase = 0; phase < period; phase++)
      value[id] = fmax(value[id], of(tangent, period, phase, measured->plan->options.shock_scale));
    tangent += period;
  }
}

void kz_measure_reactivity(const kz_measured *measured, double *value) {
  largest_growth(measured, next_growth, value);
}

void kz_measure_amplification(const kz_measured *measured, double *value) {
  largest_growth(measured, later_growth, value);
}
