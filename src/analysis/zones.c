/* Edges of the zones of stability under any wave form, as k over m: Hill's determinant, and Meissner's closed form. */
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>

#include "curves.h"

/* Curves 1 .. 5: true for half harmonics (multiplier -1); number of edges of this kind below; k at m = 0. */
static const struct {
  bool half;
  int below;
  double axis;
} edges[] = {{false, 0, 0}, {true, 0, 0.25}, {true, 1, 0.25}, {false, 1, 1}, {false, 2, 1}};

/* The infinite matrix of a solution's harmonics w: w^2 on the diagonal, m F_(w - w') beside it. Its eigenvalues are the
 * edges. Rows are ordered from the largest |w| to the smallest; the first `outer` are positive definite less any k. */
typedef struct {
  const kz_pendulum *form;
  double m, top; /* Drive; largest |w| */
  int rows, outer, band, below;
  double complex *remainder_rows; /* [rows][band + 1]: each row from its diagonal on, after elimination */
} matrix;

static double harmonic_of_row(const matrix *h, int row) {
  const double size = h->top - row / 2; /* NOLINT(bugprone-integer-division): two rows for each size */
  return row % 2 == 0 ? size : -size;
}

/* Coefficient of exp(i l t) in m f(t). */
static double complex coupling_of(const matrix *h, int l) {
  const int j = abs(l);
  if (j == 0 || (j > 1 && j > h->form->harmonics)) return 0;
  const double cosine = h->form->vertical[j - 1][0] + (j == 1 ? h->form->m : 0), sine = h->form->vertical[j - 1][1];
  return 0.5 * h->m * (cosine + (l > 0 ? -I : I) * sine);
}

/* Eigenvalue number `below` of the matrix less k after elimination of the outer harmonics: it falls with k, with a
 * slope of -1 or steeper, and is 0 at the edge. */
static double eigenvalue_less_k(double k, void *context) {
  const matrix *h = context;
  const int width = h->band + 1, inner = h->rows - h->outer;
  for (int row = 0; row < h->rows; row++)
    for (int j = 0; j < width && row + j < h->rows; j++) {
      const double w = harmonic_of_row(h, row);
      h->remainder_rows[row * width + j] =
          j == 0 ? w * w - k : coupling_of(h, (int)lrint(w - harmonic_of_row(h, row + j)));
    }
  for (int row = 0; row < h->outer; row++) {
    const double complex *pivot = h->remainder_rows + row * width;
    for (int i = 1; i < width && row + i < h->rows; i++)
      for (int j = i; j < width && row + j < h->rows; j++)
        h->remainder_rows[(row + i) * width + j - i] -= conj(pivot[i]) * pivot[j] / creal(pivot[0]);
  }
  gsl_matrix_complex *left = gsl_matrix_complex_calloc((size_t)inner, (size_t)inner);
  gsl_vector *values = gsl_vector_alloc((size_t)inner);
  gsl_eigen_herm_workspace *work = gsl_eigen_herm_alloc((size_t)inner);
  for (int i = 0; i < inner; i++)
    for (int j = i; j < inner && j - i < width; j++) {
      const double complex x = h->remainder_rows[(h->outer + i) * width + j - i];
      gsl_matrix_complex_set(left, (size_t)i, (size_t)j, gsl_complex_rect(creal(x), cimag(x)));
      gsl_matrix_complex_set(left, (size_t)j, (size_t)i, gsl_complex_rect(creal(x), -cimag(x)));
    }
  gsl_eigen_herm(left, values, work);
  gsl_sort_vector(values);
  const double value = gsl_vector_get(values, (size_t)h->below);
  gsl_eigen_herm_free(work);
  gsl_vector_free(values);
  gsl_matrix_complex_free(left);
  return value;
}

double kz_hill_edge(const kz_pendulum *form, int curve, double m) {
  const bool half = edges[curve - 1].half;
  const double axis = edges[curve - 1].axis, reach = fabs(m) * kz_stiffness(form);
  const int highest = form->harmonics > 1 ? form->harmonics : 1;
  if (m == 0 || reach == 0) return axis;
  if (!(fabs(m) <= KZ_HILL_MOST_M)) return NAN;
  /* |m f| <= reach: an edge lies within `reach` of its place on the axis, and larger harmonics than `most` have w^2 - k
   * above the drive */
  const int most = 2 + (int)sqrt(axis + 2 * reach), top = most + 12 + 4 * highest;
  matrix h = {.form = form, .m = m, .band = 2 * highest + 1, .below = edges[curve - 1].below};
  h.top = half ? top - 0.5 : top;
  h.rows = half ? 2 * top : 2 * top + 1;
  h.outer = 2 * (top - most);
  h.remainder_rows = kz_calloc((size_t)h.rows * (size_t)(h.band + 1), sizeof *h.remainder_rows);
  const double k =
      kz_root(eigenvalue_less_k, &h, axis - reach * (1 + 1e-9) - 1e-300, axis + reach * (1 + 1e-9) + 1e-300);
  free(h.remainder_rows);
  return k;
}

/* Angle in the same quarter turn whose tangent is `factor` times as large. */
static double stretch_angle(double angle, double factor) {
  const double base = M_PI * rint(angle / M_PI), remainder_rows = angle - base;
  return base + atan2(factor * sin(remainder_rows), cos(remainder_rows));
}

/* Pruefer's angle of w'' + x w = 0, w = r sin(angle), w' = r cos(angle), after a quarter of a drive period. */
static double after_quarter(double angle, double x) {
  const double root = sqrt(fabs(x)), length = M_PI / 2;
  if (x > 0) return stretch_angle(stretch_angle(angle, root) + root * length, 1 / root);
  const double w = sin(angle), slope = cos(angle), grown = tanh(root * length),
               by_root = root > 0 ? grown / root : length;
  return angle + remainder(atan2(w + by_root * slope, slope + root * grown * w) - angle, 2 * M_PI);
}

/* An edge of one of the four symmetries: the solution has the angle `first` at t = 0 and `last` at t = pi. */
typedef struct {
  double m, first, last;
} symmetry;

static double angle_residual(double k, void *context) {
  const symmetry *s = context;
  return after_quarter(after_quarter(s->first, k - s->m), k + s->m) - s->last;
}

double kz_meissner_edge(const kz_pendulum *form, int curve, double m) {
  (void)form;
  const double quarter = M_PI / 2, size = fabs(m), axis = edges[curve - 1].axis;
  const symmetry even[] = {{size, quarter, quarter}, {size, quarter, 2 * quarter}, {size, quarter, 3 * quarter}};
  const symmetry odd[] = {{size, 0, quarter}, {size, 0, 2 * quarter}}; /* tongue 1, tongue 2 */
  const int tongue = curve / 2;
  if (size == 0) return axis;
  symmetry s = even[tongue];
  const double low = axis - size * (1 + 1e-9), high = axis + size * (1 + 1e-9);
  const double cosine = kz_root(angle_residual, &s, low, high);
  if (tongue == 0) return cosine;
  s = odd[tongue - 1];
  const double sine = kz_root(angle_residual, &s, low, high);
  return curve % 2 == 0 ? fmin(cosine, sine) : fmax(cosine, sine);
}
