/* An ellipse grows by rings: a ring is cut into sectors, each inside a parallelogram, and joins where all of them reach the ellipse
 * inside it. */
#include <math.h>

#include "proof.h"

enum { SECTORS = 64, BATCH = 16, MOST_PERIODS = 64 };
static const double WIDTH = 0.1, LARGEST = 3; /* of a ring, relative; radius */
static const double LARGER = 1 + 1e-7;        /* so sectors are made: they overlap by more than their rounding */

/* Sector i of the ring between r and (1 + WIDTH) r: along the radius and across it. */
static kz_enclosure sector(const double centre[2], const double M[2][2], double r, int i) {
  const double outer = r * (1 + WIDTH), inner = r * cos(M_PI / SECTORS), across = outer * tan(M_PI / SECTORS);
  const double angle = 2 * M_PI * i / SECTORS, u[2] = {cos(angle), sin(angle)};
  const double out[2] = {M[0][0] * u[0] + M[0][1] * u[1], M[1][0] * u[0] + M[1][1] * u[1]};
  const double side[2] = {M[0][1] * u[0] - M[0][0] * u[1], M[1][1] * u[0] - M[1][0] * u[1]};
  const double middle = (outer + inner) / 2, half = (outer - inner) / 2 * LARGER;
  return (kz_enclosure){.theta = {centre[0] + out[0] * middle},
                        .velocity = {centre[1] + out[1] * middle},
                        .matrix = {{out[0] * half, side[0] * across * LARGER}, {out[1] * half, side[1] * across * LARGER}},
                        .reach = {1, 1}};
}

/* Whether BATCH sectors from `first` on of the ring around an ellipse all reach it. */
static bool sectors_reach(const kz_enclosure_tables *tables, const double centre[2], const kz_proof_ellipse *ellipse,
                          int first) {
  kz_enclosure set[BATCH];
  int left = BATCH;
  for (int i = 0; i < BATCH; i++) set[i] = sector(centre, ellipse->axes, ellipse->radius, first + i);
  for (int period = 0; period < MOST_PERIODS && left > 0; period++) {
    kz_enclosures_advance(tables, KZ_NEW_FRAME, left, set);
    for (int i = left - 1; i >= 0; i--) {
      if (!isfinite(set[i].reach[0])) return false;
      if (kz_ellipse_holds(ellipse, centre, &set[i])) set[i] = set[--left];
    }
  }
  return left == 0;
}

void kz_proof_grow_rings(const kz_enclosure_tables *tables, const double centre[2], kz_proof_ellipse *ellipse) {
  for (; ellipse->radius < LARGEST; ellipse->radius *= 1 + WIDTH)
    for (int first = 0; first < SECTORS; first += BATCH)
      if (!sectors_reach(tables, centre, ellipse, first)) return;
}
