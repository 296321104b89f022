/* Tables of a plan of enclosures, and the remainders of its Taylor polynomials.
 *
 * For complex time t + z, |z| <= R, the motion from a real state is compared with the solution of
 *   w' = beta w + (|k| + |m| cosh r) cosh y,  y' = w,  y(0) = 0,  w(0) = fastest
 * along the ray r = |z|: |theta'| <= w(r), |Im theta| <= y(r), since |cos(t + z)| <= cosh r and |sin theta|, |cos theta| <= cosh y.
 * Its neighbours likewise with (|k| + |m| cosh r) cosh(y) a. So theta' is analytic on the disc, its coefficients are at most w(R) R^-n
 * (Cauchy), and the rest of the polynomials is a geometric series in h / R. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "enclosure.h"

enum { MOST_STEPS = 4096, MARCHES = 400 };
static const double REST = 1e-10;   /* of velocities, rad per drive radian and step: wished for */
static const double CAUTION = 1e-9; /* relative, far above the rounding of the bounds below */

/* The comparison at radius r. */
typedef struct {
  double r, y, w;
  double a[2], slope[2]; /* of columns that begin with a = 1, slope = 0 and with a = 0, slope = 1 */
} majorant;

/* A solution of growing slope over dr: an Euler step with the slopes at its end, found by repetition and then checked. False where
 * none is found. */
static bool march(const kz_pendulum *p, double dr, majorant *at) {
  const double r = at->r + dr, stretch = fabs(p->k) + fabs(p->m) * cosh(r);
  majorant to = *at;
  to.r = r;
  for (int i = 0; i < 30; i++) {
    const double w = at->w + dr * (p->beta * to.w + stretch * cosh(to.y));
    const double y = at->y + dr * to.w;
    const bool holds = w <= to.w && y <= to.y;
    if (holds) break;
    to.w = w * (1 + CAUTION);
    to.y = (at->y + dr * to.w) * (1 + CAUTION);
    if (!(to.y < 30) || i == 29) return false;
  }
  const double stiffness = stretch * cosh(to.y), rest = 1 - dr * p->beta - dr * dr * stiffness;
  if (!(rest > 0.5)) return false;
  for (int c = 0; c < 2; c++) { /* linear: slope = old + dr (beta slope + stiffness (a + dr slope)) */
    to.slope[c] = (at->slope[c] + dr * stiffness * at->a[c]) / rest * (1 + CAUTION);
    to.a[c] = (at->a[c] + dr * to.slope[c]) * (1 + CAUTION);
  }
  *at = to;
  return true;
}

/* The largest step whose rest is REST, with the majorant that shows it; 0 where there is none. */
static double choose(const kz_pendulum *p, double fastest, majorant *best) {
  majorant at = {.w = fastest, .a = {1, 0}, .slope = {0, 1}};
  double longest = 0;
  *best = at;
  const double dr = 2.0 / MARCHES / fmax(fmax(1, fastest), sqrt(kz_stiffness(p)));
  for (int i = 0; i < 4 * MARCHES && march(p, dr, &at); i++) {
    const double h = at.r * pow(REST / at.w, 1.0 / KZ_ENCLOSURE_ORDER);
    if (h <= longest) continue;
    longest = h;
    *best = at;
  }
  return longest;
}

static kz_bounded about(double x, double error) {
  return (kz_bounded){x, fabs(x) * (1 + KZ_ROUNDING) + error};
}

/* Powers of h s in h^2 (k - m cos(t + h s)), with the cosine and its derivatives at the step's beginning t = 2 pi i / n. */
static void set_torque(const kz_pendulum *p, int32_t i, int32_t n, kz_enclosure_step *step) {
  const double h = 2 * M_PI / n, angle_error = 1e-14;
  const kz_lanes angle = kz_same(2 * M_PI * i / n);
  kz_ball sine, cosine;
  kz_enclosure_sine(&angle, &sine, &cosine);
  const double derivative[] = {cosine.mid[0], -sine.mid[0], -cosine.mid[0], sine.mid[0]};
  const double error = fmax(sine.mag[0] - fabs(sine.mid[0]), cosine.mag[0] - fabs(cosine.mid[0])) + angle_error;
  double factor = -p->m * h * h;
  for (int d = 0; d <= KZ_ENCLOSURE_ORDER; d++) {
    step->torque[d] = about(factor * derivative[d % 4], fabs(factor) * error);
    factor *= h / (d + 1);
  }
  const double gravity = p->k * h * h, torque = step->torque[0].mid + gravity;
  const double beyond = step->torque[0].mag - fabs(step->torque[0].mid);
  step->torque[0] = about(torque, beyond + KZ_ROUNDING * (fabs(gravity) + fabs(torque)));
  const double from = fabs(p->k - p->m * cos(angle[0])), to = fabs(p->k - p->m * cos(angle[0] + h));
  step->most_torque = h * (fmax(from, to) + fabs(p->m) * h * h / 8 + CAUTION * kz_stiffness(p));
}

static void set_rests(const majorant *at, kz_enclosure_plan *plan) {
  const double h = plan->step.mag, ratio = h / at->r * (1 + CAUTION);
  const double rest = pow(ratio, KZ_ENCLOSURE_ORDER) / (1 - ratio) * (1 + CAUTION);
  const double integral = rest * h / (KZ_ENCLOSURE_ORDER + 1);
  plan->velocity_rest = rest * at->w;
  plan->theta_rest = integral * at->w;
  plan->sine_rest = rest * cosh(at->y);
  for (int c = 0; c < 2; c++) {
    plan->column_velocity_rest[c] = rest * at->slope[c];
    plan->column_theta_rest[c] = integral * at->slope[c];
  }
}

kz_status kz_enclosure_plan_create(const kz_pendulum *pendulum, double fastest, kz_enclosure_plan **plan) {
  majorant at;
  const double longest = choose(pendulum, fastest, &at);
  *plan = NULL;
  if (!(longest * MOST_STEPS > 2 * M_PI)) return KZ_REFUSED;
  const int32_t n = (int32_t)(2 * M_PI / longest) + 1;
  kz_enclosure_plan *made = kz_calloc(1, sizeof *made + (size_t)n * sizeof *made->steps);
  const double h = 2 * M_PI / n;
  made->n_steps = n;
  made->step = about(h, 0);
  made->rate = about(1 / h, 0);
  made->damping = about(h * pendulum->beta, 0);
  made->decay = exp(-h * pendulum->beta) * (1 - CAUTION);
  made->fastest = fastest;
  set_rests(&at, made);
  for (int32_t i = 0; i < n; i++) set_torque(pendulum, i, n, &made->steps[i]);
  *plan = made;
  return KZ_OK;
}

void kz_enclosure_plan_free(kz_enclosure_plan *plan) {
  free(plan);
}
