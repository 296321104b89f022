#include "curves.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_mathieu.h>

typedef int (*value_fn)(int order, double q, gsl_sf_result *result);

/* Harmonics w = first, first + 1, ...; `corner` (units of m) stands in the first diagonal entry, the first off-diagonal
 * entry is m/2 sqrt(link); `index` counts eigenvalues from the lowest. axis: k at m = 0. */
typedef struct {
  value_fn gsl;
  int order, index;
  double first, corner, link, axis;
} family;
static const family families[] = {
    {gsl_sf_mathieu_a_e, 0, 0, 0.0, 0.0, 2.0, 0.0},  {gsl_sf_mathieu_b_e, 1, 0, 0.5, -0.5, 1.0, 0.25},
    {gsl_sf_mathieu_a_e, 1, 0, 0.5, 0.5, 1.0, 0.25}, {gsl_sf_mathieu_b_e, 2, 0, 1.0, 0.0, 1.0, 1.0},
    {gsl_sf_mathieu_a_e, 2, 1, 0.0, 0.0, 2.0, 1.0},
};
/* Largest q for which GSL is asked. GSL 2.7 loses digits: relative error 1e-12 at q = 3e4, 1e-8 at 1e5, 1 at 1e6. */
static const double GSL_MAX_Q = 5000;

static double k_by_gsl(int curve, double m) {
  const family *row = &families[curve - 1];
  gsl_sf_result result;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  int status = row->gsl(row->order, 2 * m, &result);
  gsl_set_error_handler(handler);
  return status == GSL_SUCCESS ? 0.25 * result.val : NAN;
}

/* Number of eigenvalues below k of the tridiagonal matrix, by the signs of its pivots (Sturm). */
static int count_below(const family *row, double m, double k, int rows) {
  int below = 0;
  double pivot = 1;
  for (int j = 0; j < rows; j++) {
    double w = row->first + j, coupling = j == 0 ? 0 : 0.25 * m * m * (j == 1 ? row->link : 1);
    pivot = w * w + (j == 0 ? row->corner * m : 0) - k - coupling / pivot;
    if (pivot == 0) pivot = DBL_MIN;
    below += pivot < 0;
  }
  return below;
}

static double k_by_pivots(int curve, double m) {
  const family *row = &families[curve - 1];
  int rows = 24 + (int)(3 * sqrt(m));
  double low = -2 * m - 1, high = 4 + 2 * m;
  for (;;) {
    double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) return middle;
    if (count_below(row, m, middle, rows) > row->index)
      high = middle;
    else
      low = middle;
  }
}

/* Returns k of a curve at m, from GSL up to GSL_MAX_Q, beyond from the tridiagonal eigenproblem. */
static double mathieu_k(int curve, double m) {
  double k = 2 * m <= GSL_MAX_Q ? k_by_gsl(curve, m) : NAN;
  return isfinite(k) ? k : k_by_pivots(curve, m);
}

typedef struct {
  int curve;
  double k;
} curve_point;

static double k_difference(double m, void *context) {
  const curve_point *point = context;
  return point->k - mathieu_k(point->curve, m);
}

double kz_mathieu_turn(int curve) {
  curve_point point = {curve, 0};
  return kz_lowest(k_difference, &point, 0.1, 2, 8);
}

/* k_difference in a form that is well-conditioned next to the axis: Hill's pivots subtract k - w^2 exactly. */
static double pivot_residual(double m, void *context) {
  const curve_point *point = context;
  double pivot = creal(kz_hill_pivot(point->k, 0, m, families[point->curve - 1].axis == 0.25 ? 0.5 : 1));
  switch (point->curve) {
    case 2:
      return pivot + 0.5 * m;
    case 3:
      return pivot - 0.5 * m;
    case 4:
      return pivot;
    default:
      return point->k * pivot - 0.5 * m * m;
  }
}

/* Returns the root next to `m` of the well-conditioned form; m itself if rounding hides it. */
static double refine_root(const curve_point *point, double m) {
  curve_point copy = *point;
  for (double part = 1e-12; part < 0.7; part *= 8) {
    double root = kz_root(pivot_residual, &copy, m * (1 - part), m * (1 + part));
    if (isfinite(root)) return root;
  }
  return m;
}

double kz_mathieu_m(int curve, double k, double turn, int upper) {
  curve_point point = {curve, k};
  double axis = families[curve - 1].axis;
  if (!isfinite(k)) return NAN;
  if (!upper && k == axis) return 0;
  if (!upper && (turn > 0 ? k < axis : k > axis)) return NAN;
  double low = upper ? turn : 0, high = turn;
  if (turn > 0 && k > mathieu_k(curve, turn)) return NAN;
  if (upper || turn == 0) {
    high = 2 * turn + fabs(k) + 1;
    while (mathieu_k(curve, high) > k) high *= 2;
  }
  double m = kz_root(k_difference, &point, low, high);
  return isfinite(m) ? refine_root(&point, m) : turn;
}
