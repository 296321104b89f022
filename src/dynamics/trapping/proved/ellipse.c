/* The first trapping region of an attractor: an ellipse around a strobe point that the n-period map F carries into
 * itself and contracts.
 *
 * In the eigenbasis M of the monodromy, E = centre + r M (unit disc), the enclosure of F gives for y in the disc
 *   r^-1 M^-1 (F - centre) = d + B z(y),  |z[i] - y[i]| <= reach[i] - 1,  |dz/dy - 1| <= jacobian_error.
 * |d| + |B| + |B (reach - 1)| < 1: F(E) lies inside E. |B| + |B jacobian_error| < 1: F contracts E in this norm, for E
 * is convex. So E holds exactly one fixed point of F, and every start in E ends on its cycle (Banach). */
#include "proof.h"

static const double LARGEST = 1, SMALLEST = 1e-5,
                    SHRINK = 0.85; /* radii; axes have an area of 1, or a length of 1 where real */

static const double CENTRE_ROUNDING = 4e-15; /* Rounding of a difference of centres, rad and rad per drive radian */

static void ellipse_advance(const kz_proof *proof, int64_t periods, kz_enclosure *set) {
  for (int64_t i = 0; i < periods && isfinite(set->reach[0]); i++)
    kz_enclosures_advance(proof->tables[KZ_ENCLOSE_DOUBLES], KZ_KEEP_FRAME, 1, set);
}

/* Real and imaginary part of the eigenvector (J01, mu - J00) of a complex mu. */
static void complex_basis(const double J[2][2], double half, double root, double M[2][2]) {
  const double scale = sqrt(fabs(J[0][1]) * root);
  M[0][0] = J[0][1] / scale;
  M[0][1] = 0;
  M[1][0] = (half - J[0][0]) / scale;
  M[1][1] = root / scale;
}

static void real_basis(const double J[2][2], double half, double root, double M[2][2]) {
  for (int c = 0; c < 2; c++) {
    const double mu = half + (c == 0 ? root : -root);
    const bool upper = fabs(J[0][1]) > fabs(J[1][0]);
    const double x = upper ? J[0][1] : mu - J[1][1], v = upper ? mu - J[0][0] : J[1][0];
    M[0][c] = x / hypot(x, v);
    M[1][c] = v / hypot(x, v);
  }
}

/* Eigenbasis of the monodromy, to some digits; false if eigenvalues are too close, or it is not bounded. */
static bool find_axes(const kz_proof *proof, int64_t period, const double centre[2], double M[2][2]) {
  const double tiny = 1e-6;
  kz_enclosure near = {
      .theta = {centre[0]}, .velocity = {centre[1]}, .matrix = {{tiny, 0}, {0, tiny}}, .reach = {1, 1}};
  ellipse_advance(proof, period, &near);
  if (!isfinite(near.reach[0])) return false;
  double J[2][2];
  for (int i = 0; i < 4; i++) J[i / 2][i % 2] = near.matrix[i / 2][i % 2] / tiny;
  const double half = (J[0][0] + J[1][1]) / 2, square = half * half - kz_determinant(J);
  if (!(fabs(square) > 1e-8) || fabs(J[0][1]) + fabs(J[1][0]) < 1e-8) return false;
  (square < 0 ? complex_basis : real_basis)(J, half, sqrt(fabs(square)), M);
  return fabs(kz_determinant(M)) > 1e-6;
}

static double spectral_norm(const double B[2][2]) {
  const double squares = B[0][0] * B[0][0] + B[0][1] * B[0][1] + B[1][0] * B[1][0] + B[1][1] * B[1][1];
  const double det = kz_determinant(B);
  return sqrt((squares + sqrt(fmax(squares * squares - 4 * det * det, 0))) / 2);
}

/* Length of |B| x, x >= 0. */
static double length_of(const double B[2][2], double x, double y) {
  return hypot(fabs(B[0][0]) * x + fabs(B[0][1]) * y, fabs(B[1][0]) * x + fabs(B[1][1]) * y);
}

bool kz_proof_traps(const kz_proof *proof, int64_t period, double theta, double velocity,
                    const kz_proof_ellipse *ellipse) {
  const double r = ellipse->radius, most = 1 - KZ_PROOF_ROUNDING;
  kz_enclosure set = kz_set_around((double[]){theta, velocity}, ellipse);
  ellipse_advance(proof, period, &set);
  if (!isfinite(set.reach[0])) return false;
  const double off[2] = {remainder(set.theta[0] - theta, 2 * M_PI) / r, (set.velocity[0] - velocity) / r};
  double inverse[2][2];
  kz_invert(ellipse->axes, inverse);
  const double rounded = length_of(inverse, CENTRE_ROUNDING / r, CENTRE_ROUNDING / r);
  double d[2], B[2][2];
  kz_proof_solve(ellipse->axes, off, d);
  for (int j = 0; j < 2; j++) {
    const double column[2] = {set.matrix[0][j] / r, set.matrix[1][j] / r};
    double z[2];
    kz_proof_solve(ellipse->axes, column, z);
    B[0][j] = z[0];
    B[1][j] = z[1];
  }
  const double norm = spectral_norm(B), moved = length_of(B, set.reach[0] - 1, set.reach[1] - 1);
  const double varied = hypot(length_of(B, set.jacobian_error[0][0], set.jacobian_error[1][0]),
                              length_of(B, set.jacobian_error[0][1], set.jacobian_error[1][1]));
  return hypot(d[0], d[1]) + rounded + norm + moved < most && norm + varied < most;
}

kz_proof_ellipse kz_proof_find_trap(const kz_proof *proof, int64_t period, double theta, double velocity) {
  const double centre[2] = {theta, velocity};
  kz_proof_ellipse ellipse = {.radius = 0};
  if (!find_axes(proof, period, centre, ellipse.axes)) return ellipse;
  ellipse.radius = LARGEST;
  while (ellipse.radius > SMALLEST && !kz_proof_traps(proof, period, theta, velocity, &ellipse))
    ellipse.radius *= SHRINK;
  if (!(ellipse.radius > SMALLEST)) ellipse.radius = 0;
  return ellipse;
}

/* ---- rings, cut into sectors inside parallelograms; a ring joins if all of them reach the ellipse inside it ---- */

enum { SECTORS = 64, BATCH = 16, MOST_PERIODS = 64 };
static const double WIDTH = 0.1, WIDEST = 3; /* Relative width of a ring; largest radius */
static const double LARGER = 1 + 1e-7;       /* Enlargement of sectors: they overlap by more than their rounding */

/* Sector i of the ring between r and (1 + WIDTH) r: along the radius and across it. */
static kz_enclosure ellipse_sector(const double centre[2], const double M[2][2], double r, int i) {
  const double outer = r * (1 + WIDTH), inner = r * cos(M_PI / SECTORS), across = outer * tan(M_PI / SECTORS);
  const double angle = 2 * M_PI * i / SECTORS, u[2] = {cos(angle), sin(angle)};
  const double out[2] = {M[0][0] * u[0] + M[0][1] * u[1], M[1][0] * u[0] + M[1][1] * u[1]};
  const double side[2] = {M[0][1] * u[0] - M[0][0] * u[1], M[1][1] * u[0] - M[1][0] * u[1]};
  const double middle = (outer + inner) / 2, half = (outer - inner) / 2 * LARGER;
  return (kz_enclosure){
      .theta = {centre[0] + out[0] * middle},
      .velocity = {centre[1] + out[1] * middle},
      .matrix = {{out[0] * half, side[0] * across * LARGER}, {out[1] * half, side[1] * across * LARGER}},
      .reach = {1, 1}};
}

/* Whether BATCH sectors from `first` on of the ring around an ellipse all reach it. */
static bool sectors_reach(const kz_enclosure_tables *tables, const double centre[2], const kz_proof_ellipse *ellipse,
                          int first) {
  kz_enclosure set[BATCH];
  int left = BATCH;
  for (int i = 0; i < BATCH; i++) set[i] = ellipse_sector(centre, ellipse->axes, ellipse->radius, first + i);
  for (int period = 0; period < MOST_PERIODS && left > 0; period++) {
    kz_enclosures_advance(tables, KZ_NEW_FRAME, left, set);
    for (int i = left - 1; i >= 0; i--) {
      if (!isfinite(set[i].reach[0])) return false;
      if (kz_ellipse_holds(ellipse, centre, &set[i])) set[i] = set[--left];
    }
  }
  return left == 0;
}

/* Grows an ellipse by rings: every start in the larger ellipse is proved to reach the one before. */
static void grow_rings(const kz_enclosure_tables *tables, const double centre[2], kz_proof_ellipse *ellipse) {
  for (; ellipse->radius < WIDEST; ellipse->radius *= 1 + WIDTH)
    for (int first = 0; first < SECTORS; first += BATCH)
      if (!sectors_reach(tables, centre, ellipse, first)) return;
}

kz_proof_ellipse kz_proof_find_ellipse(const kz_proof *proof, int64_t period, double theta, double velocity) {
  kz_proof_ellipse ellipse = kz_proof_find_trap(proof, period, theta, velocity);
  if (ellipse.radius > 0) grow_rings(proof->tables[KZ_ENCLOSE_DOUBLES], (double[]){theta, velocity}, &ellipse);
  return ellipse;
}

/* Whether all starts of an ellipse reach the mirror image of another. */
static bool reaches_mirror(const kz_proof *proof, int64_t most_periods, const double start[2],
                           const kz_proof_ellipse *from, const double centre[2], const kz_proof_ellipse *ellipse) {
  const double mirrored[2] = {-centre[0], -centre[1]};
  kz_enclosure set = kz_set_around(start, from);
  for (int64_t period = 0; period < most_periods && isfinite(set.reach[0]); period++) {
    if (kz_ellipse_holds(ellipse, mirrored, &set)) return true;
    kz_enclosures_advance(proof->tables[KZ_ENCLOSE_DOUBLES], KZ_NEW_FRAME, 1, &set);
  }
  return false;
}

bool kz_proof_is_mirror(const kz_proof *proof, int64_t period, const double point[2], const double centre[2],
                        const kz_proof_ellipse *ellipse) {
  if (!proof->mirrored) return true;
  kz_proof_ellipse trap = kz_proof_find_trap(proof, period, point[0], point[1]);
  for (; trap.radius > SMALLEST; trap.radius /= 4)
    if (kz_proof_traps(proof, period, point[0], point[1], &trap) &&
        reaches_mirror(proof, MOST_PERIODS * period, point, &trap, centre, ellipse))
      return true;
  return false;
}

static void ellipse_add(kz_proof *proof, uint8_t number, double theta, double velocity,
                        const kz_proof_ellipse *ellipse) {
  kz_proof_part *part = &proof->part[proof->n_parts++];
  *part = (kz_proof_part){.ellipse = *ellipse, .centre = {theta, velocity}, .number = number};
  for (int i = 0; i < 2; i++) part->half[i] = 1.001 * ellipse->radius * hypot(ellipse->axes[i][0], ellipse->axes[i][1]);
  kz_proof_draw(proof, part);
}

void kz_proof_add(kz_proof *proof, uint8_t number, uint8_t mirror, double theta, double velocity,
                  const kz_proof_ellipse *ellipse) {
  ellipse_add(proof, number, theta, velocity, ellipse);
  if (mirror != number) ellipse_add(proof, mirror, -theta, -velocity, ellipse);
}
