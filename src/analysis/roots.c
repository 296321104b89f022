#include "curves.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_roots.h>

enum { MOST_STEPS = 200 };

double kz_root(kz_real_fn fn, void *context, double low, double high) {
  gsl_function function = {fn, context};
  double at_low = fn(low, context), at_high = fn(high, context);
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  if (!isfinite(at_low) || !isfinite(at_high) || signbit(at_low) == signbit(at_high)) return NAN;
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!solver) return NAN;
  double root = NAN;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  if (gsl_root_fsolver_set(solver, &function, low, high) == GSL_SUCCESS) {
    for (int step = 0; step < MOST_STEPS; step++) {
      if (gsl_root_fsolver_iterate(solver) != GSL_SUCCESS) break;
      root = gsl_root_fsolver_root(solver);
      double width = gsl_root_fsolver_x_upper(solver) - gsl_root_fsolver_x_lower(solver);
      if (width <= 4 * DBL_EPSILON * fabs(root)) break;
    }
  }
  gsl_set_error_handler(handler);
  gsl_root_fsolver_free(solver);
  return root;
}

double kz_lowest(kz_real_fn fn, void *context, double low, double guess, double high) {
  gsl_function function = {fn, context};
  gsl_min_fminimizer *solver = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
  if (!solver) return NAN;
  double lowest = guess;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  if (gsl_min_fminimizer_set(solver, &function, guess, low, high) == GSL_SUCCESS) {
    for (int step = 0; step < MOST_STEPS; step++) {
      if (gsl_min_fminimizer_iterate(solver) != GSL_SUCCESS) break;
      lowest = gsl_min_fminimizer_x_minimum(solver);
      double width = gsl_min_fminimizer_x_upper(solver) - gsl_min_fminimizer_x_lower(solver);
      if (width <= 4 * DBL_EPSILON * fabs(lowest)) break;
    }
  }
  gsl_set_error_handler(handler);
  gsl_min_fminimizer_free(solver);
  return lowest;
}
