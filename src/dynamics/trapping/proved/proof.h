/* Internals of the proofs (dynamics_proof.h): proved regions of starts, and sets that are followed into them. */
#pragma once

#include "kapitza/dynamics_proof.h"

/* An ellipse of the region, with the box around it, which excludes most sets quickly. */
typedef struct {
  kz_proof_ellipse ellipse;
  double centre[2], half[2]; /* rad, rad per drive radian */
  uint8_t number;
} kz_proof_part;

struct kz_proof {
  kz_enclosure_tables *tables[KZ_ENCLOSURES];
  int64_t columns, rows; /* even */
  bool mirrored;         /* whether the second half of the grid is the mirror image of the first */
  double beta;
  double top;     /* rad per drive radian: rows go from -top to top */
  uint8_t *label; /* [rows][columns]: attractor, 0 = open; closed cells */
  int n_parts;
  kz_proof_part part[2 * KZ_PROOF_MOST];
};

/* half [2] = half the width of a cell: rad, rad per drive radian. */
void kz_proof_half_cell(const kz_proof *proof, double half[2]);
/* state [2] = centre of cell f, exactly mirrored: rad, rad per drive radian. */
void kz_proof_centre(const kz_proof *proof, int64_t f, double state[2]);
/* Gives all cells inside a part the number of its attractor. */
void kz_proof_draw(kz_proof *proof, const kz_proof_part *part);

/* The attractor whose region contains a set; 0 if none does. */
uint8_t kz_proof_holds(const kz_proof *proof, const kz_enclosure *set);
/* True if a set lies inside an ellipse. */
bool kz_ellipse_holds(const kz_proof_ellipse *ellipse, const double centre[2], const kz_enclosure *set);

/* An ellipse that the map of `period` drive periods carries into itself and contracts; radius 0: none was found. */
kz_proof_ellipse kz_proof_find_trap(const kz_proof *proof, int64_t period, double theta, double velocity);

static inline double kz_determinant(const double M[2][2]) {
  return M[0][0] * M[1][1] - M[0][1] * M[1][0];
}

/* A set that contains an ellipse around a centre. */
static inline kz_enclosure kz_set_around(const double centre[2], const kz_proof_ellipse *ellipse) {
  kz_enclosure set = {.theta = {centre[0]}, .velocity = {centre[1]}, .reach = {1, 1}};
  for (int i = 0; i < 4; i++) set.matrix[i / 2][i % 2] = ellipse->radius * ellipse->axes[i / 2][i % 2];
  return set;
}

/* z with M z = x. */
static inline void kz_proof_solve(const double M[2][2], const double x[2], double z[2]) {
  const double det = kz_determinant(M);
  z[0] = (M[1][1] * x[0] - M[0][1] * x[1]) / det;
  z[1] = (M[0][0] * x[1] - M[1][0] * x[0]) / det;
}

static inline void kz_invert(const double M[2][2], double inverse[2][2]) {
  const double det = kz_determinant(M);
  inverse[0][0] = M[1][1] / det;
  inverse[0][1] = -M[0][1] / det;
  inverse[1][0] = -M[1][0] / det;
  inverse[1][1] = M[0][0] / det;
}

/* Relative margin of decisive tests, above their own rounding. */
#define KZ_PROOF_ROUNDING 1e-9
