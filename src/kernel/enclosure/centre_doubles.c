/* A step of centres in doubles. A centre is high + low, so that increments are rounded, but not the sum. */
#include "sines.h"

enum { P = KZ_ORDER_DOUBLES };

/* Coefficients of one order of velocity, sine and cosine, together so that one address serves all three. */
typedef struct {
  vector w[KZ_PARTS], s[KZ_PARTS], c[KZ_PARTS];
} coefficients;

#define EACH_PART for (int p = 0; p < KZ_PARTS; p++)
#define FACTOR_along(i) broadcast_value(speed->along[first + (i)].high)
#define FACTOR_across(i) broadcast_value(speed->across[first + (i)].high)
#define FACTOR_w(i) x[i].w[p]
#define UNIT_w speed->inverse
#define UNIT_s speed->step
#define UNIT_c speed->step

#define KZ_NEXT next_order
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, coefficients *x
#define KZ_SUM(sum) vector sum[KZ_PARTS] = {{0}}
#define KZ_TERMS _Pragma("GCC unroll 1") for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(sum, a, b) EACH_PART sum[p] = multiply_add(FACTOR_##a(i), x[n - i].b[p], sum[p])
#define KZ_DAMP(sum) EACH_PART sum[p] = broadcast_value(speed->damping.high) * x[n].w[p]
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(sum) EACH_PART sum[p] -= speed->torque[first + n].high
#define KZ_SET(name, sign, sum) EACH_PART x[n + 1].name[p] = sum[p] * (sign UNIT_##name[n].high)
#include "taylor/motion.inc"

/* The state at the end of the step: h v without error to first order, the rest of the sums in doubles. */
KZ_INLINE void end_step(const kz_speed_class *speed, const coefficients *y, int p, kz_sets *x) {
  vector d_velocity = broadcast_value(0), d_theta = broadcast_value(0);
  for (int n = P - 1; n > 0; n--) {
    d_velocity += y[n].w[p];
    d_theta = multiply_add(broadcast_value(speed->step[n].high), y[n].w[p], d_theta);
  }
  const vector h = broadcast_value(speed->step[0].high);
  const pair drift = exact_product(y[0].w[p], h);
  const vector rest =
      multiply_add(h, x->velocity.low, multiply_add(broadcast_value(speed->step[0].low), y[0].w[p], drift.low));
  d_theta += rest + x->theta.low;
  const pair moved = two_sum(x->theta.high, drift.high);
  x->theta = two_sum(moved.high, moved.low + d_theta);
  x->velocity = two_sum(x->velocity.high, d_velocity + x->velocity.low);
}

void kz_centres_step_doubles(const kz_speed_class *speed, int32_t step, kz_sets *sets, int n,
                             kz_circle circle[KZ_PARTS]) {
  _Alignas(VECTOR_BYTES) coefficients x[P];
  EACH_PART {
    x[0].w[p] = sets[p].velocity.high;
    sine_in_doubles(sets[p].theta, &x[0].s[p], &x[0].c[p]);
    sets[p].max_sine = sine_bound(speed, x[0].s[p], sets[p].velocity.high);
  }
  for (int order = 0; order + 1 < P; order++) next_order(speed, step * speed->order, x, order);
  EACH_PART {
    for (int i = 0; i < n; i++) circle[p].cosine[i] = x[i].c[p];
    for (int i = 0; i < n && speed->has_across; i++) circle[p].sine[i] = x[i].s[p];
    end_step(speed, x, p, &sets[p]);
  }
}
