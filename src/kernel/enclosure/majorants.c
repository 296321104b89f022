#include "majorants.h"

#include <math.h>

#include "sets.h"

static const real MARGIN = 1e-9L; /* relative, far above the rounding of the bounds */

/* (B0) For complex time t + z, |z| <= R, the motion from a real state is compared with the solution of
 *   w' = beta w + a(r) cosh y,  y' = w,  y(0) = 0,  w(0) = fastest
 * along the ray r = |z|: |theta'| <= w(r), |Im theta| <= y(r), since kz_force_majorant a(r) bounds the force and |sin theta|, |cos theta| <= cosh y.
 * Its neighbours likewise with a(r) cosh(y) times their distance. */

/* An Euler step with the slopes at its end, found by repetition and then checked: all of them grow. */
static bool march(const kz_pendulum *p, real dr, majorant *at) {
  const real r = at->r + dr, torque = kz_force_majorant(p, r);
  majorant to = *at;
  to.r = r;
  bool holds = false;
  for (int i = 0; i < 60 && !holds && to.y < 25; i++) {
    const real w = at->w + dr * (p->beta * to.w + torque * coshl(to.y)), y = at->y + dr * to.w;
    if (w * (1 + MARGIN / 8) <= to.w && y * (1 + MARGIN / 8) <= to.y) {
      holds = true;
    } else {
      to.w = w * (1 + MARGIN);
      to.y = (at->y + dr * to.w) * (1 + MARGIN);
    }
  }
  if (!holds) return false;
  const real stiffness = torque * coshl(to.y), rest = 1 - dr * p->beta - dr * dr * stiffness;
  if (!(rest > 0.5L)) return false;
  for (int c = 0; c < 2; c++) { /* linear: slope = old + dr (beta slope + stiffness (a + dr slope)) */
    to.slope[c] = (at->slope[c] + dr * stiffness * at->a[c]) / rest * (1 + MARGIN);
    to.a[c] = (at->a[c] + dr * to.slope[c]) * (1 + MARGIN);
  }
  *at = to;
  return true;
}

int kz_majorants_find(const kz_pendulum *pendulum, double fastest, majorant *list) {
  const double scale = fmax(fmax(1, fastest), sqrt(kz_stiffness(pendulum)));
  majorant at = {.w = fastest, .a = {1, 0}, .slope = {0, 1}};
  int n = 0;
  while (n < MAJORANTS && march(pendulum, 6.0L / MAJORANTS / scale, &at)) list[n++] = at;
  return n;
}
