/* A step of centres in doubles. A centre is high + low, so that what is added to it is rounded, but not the sum. */
#include "sines.h"

enum { P = KZ_ORDER_DOUBLES };

/* Of one order: coefficients of the velocity, of sine and cosine. Those of an order lie together, so that one address serves all three. */
typedef struct {
  vector w[KZ_PARTS], s[KZ_PARTS], c[KZ_PARTS];
} coefficients;

#define EACH_PART for (int p = 0; p < KZ_PARTS; p++)
#define FACTOR_along(i) same(speed->along[first + (i)].high)
#define FACTOR_across(i) same(speed->across[first + (i)].high)
#define FACTOR_w(i) x[i].w[p]
#define UNIT_w speed->inverse
#define UNIT_s speed->step
#define UNIT_c speed->step

#define KZ_NEXT next_order
#define KZ_ARGUMENTS const kz_speed_class *speed, int32_t first, coefficients *x
#define KZ_SUM(sum) vector sum[KZ_PARTS] = {{0}}
#define KZ_TERMS _Pragma("GCC unroll 1") for (int64_t i = n; i >= 0; i--)
#define KZ_GAIN(sum, a, b) EACH_PART sum[p] = fused(FACTOR_##a(i), x[n - i].b[p], sum[p])
#define KZ_DAMP(sum) EACH_PART sum[p] = same(speed->damping.high) * x[n].w[p]
#define KZ_HAS_ACROSS speed->has_across
#define KZ_PUSH(sum) EACH_PART sum[p] -= speed->torque[first + n].high
#define KZ_SET(name, sign, sum) EACH_PART x[n + 1].name[p] = sum[p] * (sign UNIT_##name[n].high)
#include "taylor/motion.inc"

/* The state at the end of the step: h v without error to first order, the rest of the sums in doubles. */
OPERATION void finish(const kz_speed_class *speed, const coefficients *y, int p, kz_sets *x) {
  vector faster = same(0), farther = same(0);
  for (int n = P - 1; n > 0; n--) {
    faster += y[n].w[p];
    farther = fused(same(speed->step[n].high), y[n].w[p], farther);
  }
  const vector h = same(speed->step[0].high);
  const pair drift = exact_product(y[0].w[p], h);
  const vector rest = fused(h, x->velocity.low, fused(same(speed->step[0].low), y[0].w[p], drift.low));
  farther += rest + x->theta.low;
  const pair moved = sum(x->theta.high, drift.high);
  x->theta = sum(moved.high, moved.low + farther);
  x->velocity = sum(x->velocity.high, faster + x->velocity.low);
}

void kz_centres_step_doubles(const kz_speed_class *speed, int32_t step, kz_sets *sets, int n, kz_circle circle[KZ_PARTS]) {
  _Alignas(VECTOR_BYTES) coefficients x[P];
  EACH_PART {
    x[0].w[p] = sets[p].velocity.high;
    sine_in_doubles(sets[p].theta, &x[0].s[p], &x[0].c[p]);
    sets[p].most_sine = sine_bound(speed, x[0].s[p], sets[p].velocity.high);
  }
  for (int order = 0; order + 1 < P; order++) next_order(speed, step * speed->order, x, order);
  EACH_PART {
    for (int i = 0; i < n; i++) circle[p].cosine[i] = x[i].c[p];
    for (int i = 0; i < n && speed->has_across; i++) circle[p].sine[i] = x[i].s[p];
    finish(speed, x, p, &sets[p]);
  }
}
