#include <gsl/gsl_integration.h>
#include <gsl/gsl_poly.h>

#include "kapitza/analysis.h"

/* The energy of the slow equation (model.h), the integral of pull sin(theta), is, with u = 1 - k cos(theta), k (1 -
 * cos) + m^2/(2 k^2) (G(u) - G(1 - k)), G(u) = ln(u^2 + beta^2)/2 - u + beta atan(u/beta). */
static double drive_primitive(double u, double beta) {
  return 0.5 * log(u * u + beta * beta) - u + (beta > 0 ? beta * atan2(u, beta) : 0);
}

typedef struct {
  double k, beta;
} slow_equation;

static double drive_integrand(double cosine, void *context) {
  const slow_equation *s = context;
  return cosine * kz_slow_fraction(s->k, s->beta, cosine);
}

/* Energy of the drive by quadrature, without cancellation by k^2; exact to rounding for |k| <= 0.1. */
static double by_quadrature(const slow_equation *s, double cosine) {
  gsl_integration_fixed_workspace *rule =
      gsl_integration_fixed_alloc(gsl_integration_fixed_legendre, 24, cosine, 1, 0, 0);
  if (!rule) return NAN;
  gsl_function function = {drive_integrand, (void *)s};
  double sum;
  gsl_integration_fixed(&function, &sum, rule);
  gsl_integration_fixed_free(rule);
  return 0.5 * sum;
}

static double by_closed_form(const slow_equation *s, double cosine) {
  return (drive_primitive(1 - s->k * cosine, s->beta) - drive_primitive(1 - s->k, s->beta)) / (2 * s->k * s->k);
}

void kz_potential_energy(double k, double beta, double m, double theta, kz_energy *energy) {
  const slow_equation s = {k, beta};
  double cosine = cos(theta), sine = sin(theta), lift = 2 * k * pow(sin(0.5 * theta), 2);
  double drive;
  if (cosine == 1)
    drive = 0;
  else
    drive = fabs(k) <= 0.1 ? by_quadrature(&s, cosine) : by_closed_form(&s, cosine);
  energy->exact = lift + m * m * drive;
  energy->blackburn = lift + 0.25 * m * m * sine * sine * kz_slow_fraction(k, beta, cosine);
  energy->simple = lift + 0.25 * m * m * sine * sine;
}

/* Returns the lowest cosine at which kz_slow_pull changes its sign, 1 if there is none. pull (u^2 + beta^2) is a
 * quadratic in the cosine, here divided by max(1, k^2) so that nothing overflows. */
static double first_balance(double k, double beta, double m) {
  const double unit = fmax(1, fabs(k));
  const double share = k / unit, drive = 0.5 * (m / unit) * (m / unit);
  double first = 1, second = 1;
  gsl_poly_solve_quadratic(k * (share * share - drive), drive - 2 * share * share, share * (1 + beta * beta) / unit,
                           &first, &second);
  if (first > -1 && first < 1) return first;
  return second > -1 && second < 1 ? second : 1;
}

void kz_potential_rim(double k, double beta, double m, kz_rim *rim) {
  rim->stable_inverted = kz_slow_pull(k, beta, m, -1) < 0;
  rim->exact = rim->stable_inverted ? acos(first_balance(k, beta, m)) : NAN;
  rim->simple = m * m > 2 * k ? acos(fmin(1, -2 * k / (m * m))) : NAN;
}
