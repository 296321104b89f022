/* Statistics (GSL): straight lines through points, bounds of shares, lifetimes. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_uint.h>

#include "kapitza/analysis.h"

kz_line kz_fit_line(int64_t n, const double *x, const double *y) {
  kz_line line = {NAN, NAN, NAN};
  double c00, c01, c11, residual;
  if (n < 3) return line;
  gsl_fit_linear(x, 1, y, 1, (size_t)n, &line.intercept, &line.slope, &c00, &c01, &c11, &residual);
  line.slope_stderr = sqrt(c11);
  return line;
}

double kz_share_upper(int64_t hits, int64_t n, double confidence) {
  if (hits >= n) return 1;
  if (hits == 0) return -expm1(log1p(-confidence) / (double)n);
  double low = 0, high = 1; /* GSL's inverse does not converge for some shares of thousands, and ends the program */
  for (double share = 0.5; low < share && share < high; share = (low + high) / 2)
    *(gsl_cdf_beta_P(share, (double)hits + 1, (double)(n - hits)) < confidence ? &low : &high) = share;
  return high;
}

double kz_normal_quantile(double probability) {
  return gsl_cdf_ugaussian_Pinv(probability);
}

/* Quantile of the chi-squared distribution: GSL's does not converge for many degrees of freedom, where the formula of
 * E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684, is right to 1e-5. */
static double chi_squared(double probability, double freedom) {
  if (freedom < 400) return gsl_cdf_chisq_Pinv(probability, freedom);
  const double variance = 2 / (9 * freedom);
  return freedom * pow(1 - variance + gsl_cdf_ugaussian_Pinv(probability) * sqrt(variance), 3);
}

/* Returns the lifetime if `ended` motions have ended and all motions together have lasted `total`. */
static kz_lifetime lifetime_of(int64_t ended, double total) {
  kz_lifetime life = {.ended = ended, .mean = NAN, .low = NAN, .high = INFINITY};
  if (!(total > 0)) return life;
  if (ended > 0) {
    life.mean = total / (double)ended;
    life.high = 2 * total / chi_squared(0.025, 2 * (double)ended);
  }
  life.low = 2 * total / chi_squared(ended > 0 ? 0.975 : 0.95, 2 * (double)ended + 2);
  return life;
}

kz_lifetime kz_lifetime_tail(int64_t all, uint32_t *time, double longest) {
  int64_t n = 0;
  for (int64_t i = 0; i < all; i++)
    if (time[i] != KZ_NOT_ENDED) time[n++] = time[i];
  /* The tail begins after the nine tenths of the motions that settle soonest, or after half of those that settle if
   * more than a tenth are open. */
  const int64_t open = all - n, soonest = 10 * open < all ? (9 * all) / 10 : n / 2;
  const double from = n > 0 ? gsl_stats_uint_select(time, 1, (size_t)n, (size_t)(soonest < n ? soonest : n - 1)) : 0;
  double total = (double)open * (longest - from);
  int64_t ended = 0;
  for (int64_t i = 0; i < n; i++) {
    if (time[i] <= from) continue;
    total += time[i] - from;
    ended++;
  }
  kz_lifetime life = lifetime_of(ended, total);
  life.from = from;
  life.open = open;
  return life;
}
