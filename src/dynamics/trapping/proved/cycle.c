/* Place of a proved cycle and its multipliers, from the smallest trapping ellipse around its first strobe point. */
#include "proof.h"

static const double ROUNDING =
    1e-14; /* Rounding of the few operations on numbers below 4 that compare with the strobe points */

/* The ellipse shrinks as long as it traps; false where none does. */
static bool cycle_shrink(const kz_proof *proof, int64_t period, const double centre[2], kz_proof_ellipse *ellipse) {
  const double smallest = 1e-14, factor = 0.5;
  if (!(ellipse->radius > 0)) return false;
  for (kz_proof_ellipse next = *ellipse; next.radius > smallest; *ellipse = next) {
    next.radius *= factor;
    if (!kz_proof_traps(proof, period, centre[0], centre[1], &next)) return true;
  }
  return true;
}

/* Half-widths around the published strobe points: the images of the ellipse hold the cycle's. */
static bool find_half_widths(const kz_proof *proof, const kz_proof_cycle *cycle, kz_enclosure *set, double *theta,
                             double *velocity) {
  for (int64_t j = 0; j < cycle->period; j++) {
    const double off[2] = {fabs(remainder(set->theta[0] - cycle->theta[j], 2 * M_PI)),
                           fabs(set->velocity[0] - cycle->velocity[j])};
    double half[2];
    for (int i = 0; i < 2; i++)
      half[i] = off[i] + fabs(set->matrix[i][0]) * set->reach[0] + fabs(set->matrix[i][1]) * set->reach[1] + ROUNDING;
    theta[j] = half[0];
    velocity[j] = half[1];
    kz_enclosures_advance(proof->tables[KZ_ENCLOSE_DOUBLES], KZ_KEEP_FRAME, 1, set);
    if (!isfinite(set->reach[0])) return false;
  }
  return true;
}

/* Trace of the monodromy and what it may be off by: set, the image of begin after the period, is J = A W begin^-1, |W -
 * 1| <= jacobian_error. */
static void bound_trace(const double begin[2][2], const kz_enclosure *set, double *trace, double *error) {
  double inverse[2][2];
  kz_invert(begin, inverse);
  *trace = *error = 0;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      *trace += set->matrix[i][j] * inverse[j][i];
      *error += 1e-14 * fabs(set->matrix[i][j] * inverse[j][i]);
      for (int k = 0; k < 2; k++) *error += fabs(set->matrix[i][k] * inverse[j][i]) * set->jacobian_error[k][j];
    }
}

/* The multipliers of a trace and a determinant, larger one first, as the catalogue has them. */
static void multipliers_of(double trace, double determinant, double re[2], double im[2]) {
  const double square = trace * trace / 4 - determinant, root = sqrt(fabs(square));
  const double large = trace / 2 + (trace < 0 ? -root : root);
  re[0] = square < 0 ? trace / 2 : large;
  re[1] = square < 0 ? trace / 2 : determinant / large;
  im[0] = square < 0 ? root : 0;
  im[1] = -im[0];
}

/* Distance of the published multipliers from those of any trace in the interval: each moves along the real line or a
 * short arc of a circle, and is farthest at the ends of the interval, or where the two meet. */
static void bound_multipliers(const kz_proof_cycle *cycle, double trace, double error, double determinant,
                              double half[2]) {
  const double meet = copysign(2 * sqrt(determinant), trace);
  double at[3] = {trace - error, trace + error, trace};
  if (meet > at[0] && meet < at[1]) at[2] = meet;
  half[0] = half[1] = 0;
  for (int t = 0; t < 3; t++) {
    double re[2], im[2];
    multipliers_of(at[t], determinant, re, im);
    for (int c = 0; c < 2; c++) {
      const double off = hypot(re[c] - cycle->multiplier_re[c], fabs(im[c]) - fabs(cycle->multiplier_im[c]));
      half[c] = fmax(half[c], off * (1 + 1e-6) + ROUNDING);
    }
  }
}

bool kz_proof_confine(const kz_proof *proof, const kz_proof_cycle *cycle, double *theta, double *velocity,
                      double multiplier[2]) {
  const double centre[2] = {cycle->theta[0], cycle->velocity[0]};
  kz_proof_ellipse ellipse = kz_proof_find_trap(proof, cycle->period, centre[0], centre[1]);
  if (!cycle_shrink(proof, cycle->period, centre, &ellipse)) return false;
  const kz_enclosure begin = kz_set_around(centre, &ellipse);
  kz_enclosure set = begin;
  double trace, error;
  if (!find_half_widths(proof, cycle, &set, theta, velocity)) return false;
  bound_trace(begin.matrix, &set, &trace, &error);
  bound_multipliers(cycle, trace, error, exp(-2 * M_PI * proof->beta * (double)cycle->period), multiplier);
  return true;
}
