/* An upper bound of a share from a sample. */
#include <gsl/gsl_cdf.h>
#include <math.h>

#include "kapitza/analysis.h"

double kz_share_upper(int64_t hits, int64_t n, double confidence) {
  if (hits >= n) return 1;
  if (hits == 0) return -expm1(log1p(-confidence) / (double)n);
  return gsl_cdf_beta_Pinv(confidence, (double)hits + 1, (double)(n - hits));
}
