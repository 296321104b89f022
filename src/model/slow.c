/* The slow equation of the effective potential. */
#include "kapitza/model.h"

double kz_slow_fraction(double k, double beta, double cosine) {
  const double u = 1 - k * cosine;
  return u / (u * u + beta * beta);
}

double kz_slow_pull(double k, double beta, double m, double cosine) {
  return k + 0.5 * m * m * cosine * kz_slow_fraction(k, beta, cosine);
}
