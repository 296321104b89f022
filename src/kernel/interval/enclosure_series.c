/* Taylor series of the pendulum over a step, with bounds on rounding: recurrences for sin theta and cos theta, the motion
 *   theta'' = -h beta theta' - h^2 (k - m cos t) sin theta        (' = d/ds)
 * and its linear neighbours a'' = -h beta a' - h^2 (k - m cos t) cos theta a. */
#include "enclosure.h"

/* A sum of products under way: its midpoint, the sum of the sizes of midpoints' products, that of magnitudes' products. */
typedef struct {
  kz_lanes mid, size, mag;
} products;

KZ_INLINE void add(products *sum, kz_lanes a, kz_lanes a_mag, kz_ball b) {
  const kz_lanes product = a * b.mid;
  sum->mid += product;
  sum->size += kz_abs(product);
  sum->mag += a_mag * b.mag;
}

KZ_INLINE void convolve(products *sum, int n, const kz_ball *a, const kz_ball *b) {
  for (int i = 0; i <= n; i++) add(sum, a[i].mid, a[i].mag, b[n - i]);
}

KZ_INLINE void convolve_torque(products *sum, int n, const kz_bounded *a, const kz_ball *b) {
  for (int i = 0; i <= n; i++) add(sum, kz_same(a[i].mid), kz_same(a[i].mag), b[n - i]);
}

/* The sum times a factor that is exact or rounded once. */
KZ_INLINE kz_ball scaled(const products *sum, double factor) {
  const kz_lanes mid = sum->mid * factor;
  const kz_lanes beyond = (sum->mag - sum->size + KZ_ROUNDING * sum->mag) * __builtin_fabs(factor);
  return (kz_ball){mid, kz_abs(mid) + beyond + KZ_TINY};
}

/* Coefficient i + 2 of an angle, and i + 1 of its slope, from the sum of the torque's products. */
KZ_INLINE void integrate(const kz_enclosure_plan *plan, products *sum, int i, kz_ball *angle, kz_ball *slope) {
  add(sum, kz_same(plan->damping.mid), kz_same(plan->damping.mag), slope[i]);
  slope[i + 1] = scaled(sum, -1.0 / (i + 1));
  angle[i + 2] = scaled(sum, -1.0 / ((i + 1) * (i + 2)));
}

KZ_INLINE kz_ball product_of(kz_bounded a, kz_lanes b) {
  products sum = {0};
  add(&sum, kz_same(a.mid), kz_same(a.mag), (kz_ball){b, kz_abs(b)});
  return scaled(&sum, 1);
}

static void begin(const kz_enclosure_plan *plan, kz_lanes angle, kz_lanes velocity, kz_ball *series, kz_ball *slope) {
  series[0] = (kz_ball){angle, kz_abs(angle)};
  series[1] = slope[0] = product_of(plan->step, velocity);
}

static void expand_sine(kz_enclosure_series *s, int n) {
  products sine = {0}, cosine = {0};
  convolve(&sine, n, s->slope, s->cosine);
  convolve(&cosine, n, s->slope, s->sine);
  s->sine[n + 1] = scaled(&sine, 1.0 / (n + 1));
  s->cosine[n + 1] = scaled(&cosine, -1.0 / (n + 1));
}

void kz_enclosure_expand(const kz_enclosure_plan *plan, const kz_enclosure_step *step, const kz_lanes *theta,
                         const kz_lanes *velocity, const kz_lanes column[2], const kz_lanes column_velocity[2],
                         kz_enclosure_series *s) {
  begin(plan, *theta, *velocity, s->theta, s->slope);
  for (int c = 0; c < 2; c++) begin(plan, column[c], column_velocity[c], s->column[c], s->column_slope[c]);
  kz_enclosure_sine(theta, &s->sine[0], &s->cosine[0]);
  for (int i = 0; i + 2 <= KZ_ENCLOSURE_ORDER; i++) {
    products torque = {0}, stiffness = {0};
    convolve_torque(&torque, i, step->torque, s->sine);
    convolve_torque(&stiffness, i, step->torque, s->cosine);
    integrate(plan, &torque, i, s->theta, s->slope);
    s->stiffness[i] = scaled(&stiffness, 1);
    for (int c = 0; c < 2; c++) {
      products restoring = {0};
      convolve(&restoring, i, s->stiffness, s->column[c]);
      integrate(plan, &restoring, i, s->column[c], s->column_slope[c]);
    }
    expand_sine(s, i);
  }
}

/* Of x, half of what is left of the angle without whole turns, |x| < 1.6: Taylor polynomials in nested form, whose remainder is below
 * 1e-18; then the double angle. Rounding adds at most 2^-45 to either polynomial, 2^-50 (1 + turns) to the angle. */
void kz_enclosure_sine(const kz_lanes *angle, kz_ball *sine, kz_ball *cosine) {
  enum { TERMS = 12 };
  /* 2 pi as two doubles, which leave out less than 1e-31; adding to_integer rounds to an integer. */
  const double turn = 0x1.921fb54442d18p+2, turn_rest = 0x1.1a62633145c07p-52, to_integer = 0x1.8p52;
  const kz_lanes turns = (*angle * (1 / turn) + to_integer) - to_integer;
  const kz_lanes x = 0.5 * ((*angle - turns * turn) - turns * turn_rest), square = x * x;
  kz_lanes s = kz_same(1), c = kz_same(1);
  for (int n = 2 * (TERMS - 1); n > 0; n -= 2) {
    s = 1 - s * square * (1.0 / (n * (n + 1)));
    c = 1 - c * square * (1.0 / ((n - 1) * n));
  }
  s *= x;
  const kz_lanes error = 0x1p-42 * (1 + kz_abs(turns));
  *sine = (kz_ball){2 * s * c, kz_abs(2 * s * c) + error};
  *cosine = (kz_ball){1 - 2 * s * s, kz_abs(1 - 2 * s * s) + error};
}
