/* Inside of the proof of trapping regions (dynamics.h). */
#ifndef KAPITZA_DYNAMICS_PROOF_H
#define KAPITZA_DYNAMICS_PROOF_H

#include <stdbool.h>

#include "kapitza/dynamics.h"

struct kz_proof {
  kz_enclosure_plan *plan;
  int64_t columns, rows; /* even */
  double top;            /* rad per drive radian: rows go from -top to top */
  uint8_t *label;        /* [rows][columns]: attractor, 0 = open; closed cells */
};

/* A parallelogram in units of cells: centre + a p + b q, |p|, |q| <= 1; x from theta = -pi, y from velocity = -top. */
typedef struct {
  double centre[2], a[2], b[2];
} kz_parallelogram;

/* Half of a cell: rad, rad per drive radian. */
void kz_proof_half_cell(const kz_proof *proof, double half[2]);
/* Centre of cell f: exactly mirrored. */
void kz_proof_centre(const kz_proof *proof, int64_t f, double state[2]);

/* The parallelogram that holds a set. */
kz_parallelogram kz_proof_image(const kz_proof *proof, const kz_enclosure *set);
/* False for one that is too large to be covered, or reaches beyond the grid's velocities. */
bool kz_proof_within(const kz_proof *proof, const kz_parallelogram *image);
/* The attractor that all cells of a parallelogram within the grid belong to, 0 where there is none. */
uint8_t kz_proof_cover(const kz_proof *proof, const kz_parallelogram *image);

/* z with M z = x. */
static inline void kz_proof_solve(const double M[2][2], const double x[2], double z[2]) {
  const double det = M[0][0] * M[1][1] - M[0][1] * M[1][0];
  z[0] = (M[1][1] * x[0] - M[0][1] * x[1]) / det;
  z[1] = (M[0][0] * x[1] - M[1][0] * x[0]) / det;
}
/* The radius to which an ellipse grows, ring by ring: every start in it is proved to reach it as it is. */
double kz_proof_grow_rings(const kz_enclosure_plan *plan, const double centre[2], const kz_proof_ellipse *ellipse);

/* Relative: tests that decide are passed by more than their own rounding. */
#define KZ_PROOF_ROUNDING 1e-9

#endif
