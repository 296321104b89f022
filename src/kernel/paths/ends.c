/* Ends of paths. With p = 0 the monodromy of Hamilton's flow is {{A, B}, {0, A^-T}}: an attractor's unstable plane is
 * (X p, p) with X = A X A^T + B A^T, the covariance of weak noise; a saddle's stable plane has its own stable
 * direction, and (x, q) with q A = mu q and (A - 1/mu) x = -B q. */
#include "kapitza/kernel_paths.h"

enum { MAX_ITERATIONS = 16 };
/* rad: largest move of a state to its cycle; size of Newton steps due to rounding; largest last step. */
static const double NEAR = 0.3, ROUNDED = 1e-14, CLOSED = 1e-9;

/* Solves the 2 x 2 equations; false where they are singular. */
static bool solve_pair(const double m[2][2], const double side[2], double x[2]) {
  const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  x[0] = (m[1][1] * side[0] - m[0][1] * side[1]) / determinant;
  x[1] = (m[0][0] * side[1] - m[1][0] * side[0]) / determinant;
  return isfinite(x[0]) && isfinite(x[1]);
}

/* The state after a period of the cycle, and the monodromy. */
static void ends_follow(const kz_hamilton *flow, int64_t period, double state[4], double matrix[4][4]) {
  double tangent[4][4], unused[4], product[4][4];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) matrix[i][j] = i == j;
  for (int64_t t = 0; t < period; t++) {
    kz_hamilton_advance(flow, 1, state, 1, tangent[0], 0, unused);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        product[i][j] = 0;
        for (int k = 0; k < 4; k++) product[i][j] += tangent[i][k] * matrix[k][j];
      }
    memcpy(matrix, product, sizeof product);
  }
}

static bool close_cycle(const kz_hamilton *flow, kz_path_end *end, double matrix[4][4]) {
  const double begin[2] = {end->state[0], end->state[1]};
  double step[2], before = INFINITY;
  for (int i = 0; i < MAX_ITERATIONS; i++) {
    double state[4] = {end->state[0], end->state[1]};
    ends_follow(flow, end->period, state, matrix);
    end->winding = llrint((state[0] - end->state[0]) / (2 * M_PI));
    const double side[2] = {state[0] - 2 * M_PI * (double)end->winding - end->state[0], state[1] - end->state[1]};
    const double equations[2][2] = {{1 - matrix[0][0], -matrix[0][1]}, {-matrix[1][0], 1 - matrix[1][1]}};
    if (!solve_pair(equations, side, step)) return false;
    const double length = hypot(step[0], step[1]);
    if (length < ROUNDED || (length < CLOSED && length >= 0.5 * before)) return true;
    for (int c = 0; c < 2; c++) end->state[c] += step[c];
    if (!(hypot(end->state[0] - begin[0], end->state[1] - begin[1]) < NEAR)) return false;
    before = length;
  }
  return before < CLOSED;
}

/* X = A X A^T + C for symmetric X: three linear equations by elimination. */
static void solve_covariance(const double a[2][2], const double c[3], double x[3]) {
  double m[3][4] = {{1 - a[0][0] * a[0][0], -2 * a[0][0] * a[0][1], -a[0][1] * a[0][1], c[0]},
                    {-a[0][0] * a[1][0], 1 - a[0][0] * a[1][1] - a[0][1] * a[1][0], -a[0][1] * a[1][1], c[1]},
                    {-a[1][0] * a[1][0], -2 * a[1][0] * a[1][1], 1 - a[1][1] * a[1][1], c[2]}};
  for (int k = 0; k < 3; k++) {
    int pivot = k;
    for (int i = k + 1; i < 3; i++)
      if (fabs(m[i][k]) > fabs(m[pivot][k])) pivot = i;
    for (int j = 0; j < 4; j++) {
      const double swapped = m[k][j];
      m[k][j] = m[pivot][j];
      m[pivot][j] = swapped;
    }
    for (int i = k + 1; i < 3; i++)
      for (int j = 3; j >= k; j--) m[i][j] -= m[i][k] / m[k][k] * m[k][j];
  }
  for (int k = 2; k >= 0; k--) {
    x[k] = m[k][3];
    for (int j = k + 1; j < 3; j++) x[k] -= m[k][j] * x[j];
    x[k] /= m[k][k];
  }
}

/* Makes the columns of a plane orthonormal; a matrix that moves its coordinates changes with them. */
static void normalise_plane(double (*plane)[2], double (*along)[2]) {
  double r[2][2] = {{0}}, moved[2][2];
  for (int j = 0; j < 2; j++) {
    for (int i = 0; i < 4 && j > 0; i++) r[0][1] += plane[i][0] * plane[i][1];
    for (int i = 0; i < 4 && j > 0; i++) plane[i][1] -= r[0][1] * plane[i][0];
    for (int i = 0; i < 4; i++) r[j][j] += plane[i][j] * plane[i][j];
    r[j][j] = sqrt(r[j][j]);
    for (int i = 0; i < 4; i++) plane[i][j] /= r[j][j];
  }
  for (int i = 0; i < 2; i++) { /* R along R^-1 */
    const double row[2] = {r[i][0] * along[0][0] + r[i][1] * along[1][0],
                           r[i][0] * along[0][1] + r[i][1] * along[1][1]};
    moved[i][0] = row[0] / r[0][0];
    moved[i][1] = (row[1] - moved[i][0] * r[0][1]) / r[1][1];
  }
  memcpy(along, moved, sizeof moved);
}

static void leave_attractor(const double m[4][4], kz_path_end *end) {
  double c[2][2], *x = end->covariance;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) c[i][j] = m[i][2] * end->own[j][0] + m[i][3] * end->own[j][1];
  const double side[3] = {c[0][0], 0.5 * (c[0][1] + c[1][0]), c[1][1]};
  solve_covariance((const double (*)[2])end->own, side, x);
  const double plane[4][2] = {{x[0], x[1]}, {x[1], x[2]}, {1, 0}, {0, 1}};
  memcpy(end->plane, plane, sizeof plane);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) end->along[i][j] = end->own[j][i];
  normalise_plane(end->plane, end->along);
}

/* Unit eigenvector of a 2 x 2 matrix. */
static void ends_eigenvector(const double (*m)[2], double value, double *vector) {
  const double rows[2][2] = {{m[0][1], value - m[0][0]}, {value - m[1][1], m[1][0]}};
  const int row = hypot(rows[0][0], rows[0][1]) > hypot(rows[1][0], rows[1][1]) ? 0 : 1;
  const double length = hypot(rows[row][0], rows[row][1]);
  for (int c = 0; c < 2; c++) vector[c] = rows[row][c] / length;
}

/* The two multipliers, that of larger modulus first; false where they are complex. */
static bool ends_multipliers(const double a[2][2], double value[2]) {
  const double half = 0.5 * (a[0][0] + a[1][1]), determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  const double square = half * half - determinant;
  value[0] = square > 0 ? half + copysign(sqrt(square), half) : sqrt(determinant);
  value[1] = determinant / value[0];
  return square > 0;
}

static bool approach_saddle(const double m[4][4], double stable, kz_path_end *end) {
  const double turned[2][2] = {{end->own[0][0], end->own[1][0]}, {end->own[0][1], end->own[1][1]}};
  double own[2], x[2], q[2];
  ends_eigenvector((const double (*)[2])end->own, end->growth, end->away);
  ends_eigenvector((const double (*)[2])end->own, stable, own);
  ends_eigenvector(turned, end->growth, q);
  const double equations[2][2] = {{end->own[0][0] - 1 / end->growth, end->own[0][1]},
                                  {end->own[1][0], end->own[1][1] - 1 / end->growth}};
  const double side[2] = {-(m[0][2] * q[0] + m[0][3] * q[1]), -(m[1][2] * q[0] + m[1][3] * q[1])};
  if (!solve_pair(equations, side, x)) return false;
  const double plane[4][2] = {{own[0], x[0]}, {own[1], x[1]}, {0, q[0]}, {0, q[1]}},
               along[2][2] = {{stable, 0}, {0, 1 / end->growth}};
  memcpy(end->plane, plane, sizeof plane);
  memcpy(end->along, along, sizeof along);
  normalise_plane(end->plane, end->along);
  return true;
}

bool kz_path_end_find(const kz_hamilton *flow, int64_t period, bool attracts, double theta, double velocity,
                      kz_path_end *end) {
  double matrix[4][4], value[2];
  *end = (kz_path_end){.period = period, .state = {theta, velocity}};
  if (!close_cycle(flow, end, matrix)) return false;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) end->own[i][j] = matrix[i][j];
  const bool is_real = ends_multipliers((const double (*)[2])end->own, value);
  end->growth = value[0];
  if (attracts != (fabs(value[0]) < 1)) return false;
  if (attracts) leave_attractor((const double (*)[4])matrix, end);
  return attracts || (is_real && fabs(value[1]) < 1 && approach_saddle((const double (*)[4])matrix, value[1], end));
}
