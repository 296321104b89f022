/* An ellipse grows by rings: a ring is cut into sectors, each inside a parallelogram, and joins where all of them reach the ellipse
 * inside it. */
#include <math.h>

#include "proof.h"

enum { SECTORS = 64, BATCH = 8, MOST_PERIODS = 64 };
static const double WIDTH = 0.1, LARGEST = 3; /* of a ring, relative; radius */
static const double LARGER = 1 + 1e-7;        /* so sectors are made: they overlap by more than their rounding */

/* Sector i of the ring between r and (1 + WIDTH) r: along the radius and across it. */
static kz_enclosure sector(const double centre[2], const double M[2][2], double r, int i) {
  const double outer = r * (1 + WIDTH), inner = r * cos(M_PI / SECTORS), across = outer * tan(M_PI / SECTORS);
  const double angle = 2 * M_PI * i / SECTORS, u[2] = {cos(angle), sin(angle)};
  const double out[2] = {M[0][0] * u[0] + M[0][1] * u[1], M[1][0] * u[0] + M[1][1] * u[1]};
  const double side[2] = {M[0][1] * u[0] - M[0][0] * u[1], M[1][1] * u[0] - M[1][0] * u[1]};
  const double middle = (outer + inner) / 2, half = (outer - inner) / 2 * LARGER;
  return (kz_enclosure){.theta = centre[0] + out[0] * middle,
                        .velocity = centre[1] + out[1] * middle,
                        .matrix = {{out[0] * half, side[0] * across * LARGER}, {out[1] * half, side[1] * across * LARGER}},
                        .reach = {1, 1}};
}

/* Do all states of a set lie in the ellipse of radius r? Corners of a parallelogram do. */
static bool is_inside(const kz_enclosure *set, const double centre[2], const double M[2][2], double r) {
  if (!isfinite(set->reach[0])) return false;
  for (int corner = 0; corner < 4; corner++) {
    const double y[2] = {corner % 2 ? set->reach[0] : -set->reach[0], corner / 2 ? set->reach[1] : -set->reach[1]};
    const double x[2] = {remainder(set->theta - centre[0], 2 * M_PI) + set->matrix[0][0] * y[0] + set->matrix[0][1] * y[1],
                         set->velocity - centre[1] + set->matrix[1][0] * y[0] + set->matrix[1][1] * y[1]};
    double z[2];
    kz_proof_solve(M, x, z);
    if (!(hypot(z[0], z[1]) < r * (1 - KZ_PROOF_ROUNDING))) return false;
  }
  return true;
}

/* Do BATCH sectors from `first` on all reach the ellipse of radius r? */
static bool sectors_reach(const kz_enclosure_plan *plan, const double centre[2], const double M[2][2], double r, int first) {
  kz_enclosure set[BATCH];
  int left = BATCH;
  for (int i = 0; i < BATCH; i++) set[i] = sector(centre, M, r, first + i);
  for (int period = 0; period < MOST_PERIODS && left > 0; period++) {
    kz_enclosures_advance(plan, left, set);
    for (int i = left - 1; i >= 0; i--) {
      if (!isfinite(set[i].reach[0])) return false;
      if (is_inside(&set[i], centre, M, r)) set[i] = set[--left];
    }
  }
  return left == 0;
}

double kz_proof_grow_rings(const kz_enclosure_plan *plan, const double centre[2], const kz_proof_ellipse *ellipse) {
  double r = ellipse->radius;
  for (; r < LARGEST; r *= 1 + WIDTH)
    for (int first = 0; first < SECTORS; first += BATCH)
      if (!sectors_reach(plan, centre, ellipse->axes, r, first)) return r;
  return r;
}
