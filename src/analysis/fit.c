/* Straight lines through points (GSL). */
#include <gsl/gsl_fit.h>
#include <math.h>

#include "kapitza/analysis.h"

kz_line kz_fit_line(int64_t n, const double *x, const double *y) {
  kz_line line = {NAN, NAN, NAN};
  double c00, c01, c11, residual;
  if (n < 3) return line;
  gsl_fit_linear(x, 1, y, 1, (size_t)n, &line.intercept, &line.slope, &c00, &c01, &c11, &residual);
  line.slope_stderr = sqrt(c11);
  return line;
}
