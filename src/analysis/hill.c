#include "curves.h"

#include <gsl/gsl_poly.h>

static double complex diagonal_entry(double k, double beta, double w) {
  return k - w * w + I * beta * w;
}

double complex kz_hill_pivot(double k, double beta, double m, double w) {
  double x = 0.25 * m * m;
  int rows = 20 + (int)(2 * sqrt(fabs(k) + fabs(m) + beta));
  double complex pivot = diagonal_entry(k, beta, w + rows);
  for (int j = rows - 1; j >= 0; j--) pivot = diagonal_entry(k, beta, w + j) - x / pivot;
  return pivot;
}

double kz_hill_half(double k, double beta, double m) {
  double size = cabs(kz_hill_pivot(k, beta, m, 0.5));
  return size - 0.5 * fabs(m);
}

double kz_hill_whole(double k, double beta, double m) {
  double complex pivot = kz_hill_pivot(k, beta, m, 1);
  return k * cabs(pivot) - 0.5 * m * m * creal(pivot) / cabs(pivot);
}

/* Returns m = 2 sqrt(x) of the smaller root x >= 0 of a x^2 + b x + c = 0, or of the larger one. */
static double drive_of(double a, double b, double c, bool larger) {
  double first, second;
  int roots = gsl_poly_solve_quadratic(a, b, c, &first, &second);
  if (roots == 0) return NAN;
  if (roots == 1) second = first;
  double x = first >= 0 && !larger ? first : second;
  return x >= 0 ? 2 * sqrt(x) : NAN;
}

/* |a b - x|^2 = x |b|^2 with a, b the first two diagonals. */
double kz_hill_cut_half(double k, double beta, bool larger) {
  double complex a = diagonal_entry(k, beta, 0.5), b = diagonal_entry(k, beta, 1.5), ab = a * b;
  double size_b = creal(b * conj(b));
  return drive_of(1, -(2 * creal(ab) + size_b), creal(ab * conj(ab)), larger);
}

/* k |a b - x|^2 = 2 x Re((a b - x) conj b). For k <= 0 its smaller root continues curve 1, not tongue 2. */
double kz_hill_cut_whole(double k, double beta) {
  double complex a = diagonal_entry(k, beta, 1), b = diagonal_entry(k, beta, 2), ab = a * b;
  double size_b = creal(b * conj(b));
  return drive_of(k + 2 * creal(b), -2 * (k * creal(ab) + creal(a) * size_b), k * creal(ab * conj(ab)), k <= 0);
}

double kz_hill_cut_angle(double k, double nu) {
  double d[5];
  for (int j = -2; j <= 2; j++) d[j + 2] = k - (nu + j) * (nu + j);
  double up = d[3] * d[4], down = d[1] * d[0];
  return drive_of(d[2] + d[4] + d[0], -(d[2] * (up + down) + d[4] * down + d[0] * up), d[2] * up * down, false);
}
