/* A step of centres in doubles. A centre is high + low, so that what is added to it is rounded, but not the sum. */
#include "operations.h"

enum { P = KZ_ORDER_DOUBLES, TERMS = 12 };

/* Sine and cosine of high + low: off by at most 8 u (B1). */
OPERATION void sine_of(pair theta, vector *sine, vector *cosine) {
  static const double pi[3] = KZ_PI;
  const vector count = nearest_integer(theta.high * (1 / pi[0])), sign = sign_of_parity(count);
  const vector x = fused(count, same(-pi[0]), theta.high) - count * pi[1], square = x * x;
  vector s = same(1), c = same(1);
  for (int n = 2 * TERMS; n > 0; n -= 2) {
    s = fused(same(-1.0 / (n * (n + 1))), square * s, same(1));
    c = fused(same(-1.0 / ((n - 1) * n)), square * c, same(1));
  }
  s *= x;
  *sine = sign * fused(theta.low, c, s);
  *cosine = sign * fused(-theta.low, s, c);
}

/* Coefficients of the velocity, of sine and cosine; [0] is given. */
static void expand(const kz_speed_class *speed, const kz_constant *torque, vector v[P][KZ_PARTS], vector S[P][KZ_PARTS],
                   vector C[P][KZ_PARTS]) {
  for (int n = 0; n + 1 < P; n++) {
    vector f[KZ_PARTS], s[KZ_PARTS], c[KZ_PARTS];
    for (int p = 0; p < KZ_PARTS; p++) {
      f[p] = same(speed->damping.high) * v[n][p];
      s[p] = c[p] = same(0);
    }
#pragma GCC unroll 1
    for (int i = n; i >= 0; i--) {
      const vector push = same(torque[i].high);
      for (int p = 0; p < KZ_PARTS; p++) {
        f[p] = fused(push, S[n - i][p], f[p]);
        s[p] = fused(v[i][p], C[n - i][p], s[p]);
        c[p] = fused(v[i][p], S[n - i][p], c[p]);
      }
    }
    for (int p = 0; p < KZ_PARTS; p++) {
      v[n + 1][p] = f[p] * -speed->inverse[n].high;
      S[n + 1][p] = s[p] * speed->step[n].high;
      C[n + 1][p] = c[p] * -speed->step[n].high;
    }
  }
}

/* The state at the end of the step: h v without error to first order, the rest of the sums in doubles. */
OPERATION void finish(const kz_speed_class *speed, vector v[P][KZ_PARTS], int p, kz_sets *x) {
  vector faster = same(0), farther = same(0);
  for (int n = P - 1; n > 0; n--) {
    faster += v[n][p];
    farther = fused(same(speed->step[n].high), v[n][p], farther);
  }
  const vector h = same(speed->step[0].high);
  const pair drift = exact_product(v[0][p], h);
  const vector rest = fused(h, x->velocity.low, fused(same(speed->step[0].low), v[0][p], drift.low));
  farther += rest + x->theta.low;
  const pair moved = sum(x->theta.high, drift.high);
  x->theta = sum(moved.high, moved.low + farther);
  x->velocity = sum(x->velocity.high, faster + x->velocity.low);
}

void kz_centres_step_doubles(const kz_speed_class *speed, int32_t step, kz_sets *sets, int n,
                             vector cosine[KZ_PARTS][KZ_ORDER_JACOBIAN]) {
  const kz_constant *torque = &speed->torque[step * speed->order];
  _Alignas(VECTOR_BYTES) vector v[P][KZ_PARTS], S[P][KZ_PARTS], C[P][KZ_PARTS];
  for (int p = 0; p < KZ_PARTS; p++) {
    v[0][p] = sets[p].velocity.high;
    sine_of(sets[p].theta, &S[0][p], &C[0][p]);
    bound_sine(speed, S[0][p], &sets[p]);
  }
  expand(speed, torque, v, S, C);
  for (int p = 0; p < KZ_PARTS; p++) {
    for (int i = 0; i < n; i++) cosine[p][i] = C[i][p];
    finish(speed, v, p, &sets[p]);
  }
}

void kz_enclosure_sine_doubles(int64_t n, const double *theta, double *sine, double *cosine) {
  for (int64_t i = 0; i < n; i++) {
    vector s, c;
    sine_of((pair){same(theta[2 * i]), same(theta[2 * i + 1])}, &s, &c);
    sine[i] = s[0];
    cosine[i] = c[0];
  }
}
